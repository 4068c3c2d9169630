/* The mask of a capture that has none. In the object is what some light brings above black and, where the picture's
 * edge is dark, what is on average brighter than that edge: noise and black cloth are no object. */
#include <math.h>
#include <stdlib.h>

#include "stereo/capture_parts.h"
#include "stereo/pixel_fit.h"

enum { LEAST_EDGE = 2, SAMPLE = 65536 };
/* Width of the edge, in the picture's. */
static const double edge_width = 0.02;
/* The edge is background where its median is less than the first share of what 199 of 200 pixels stay below. */
static const float dark = 0.05f;
static const double bright = 0.995;
/* What is surely no background: above the edge's median by so many of its standard deviations, which its median
 * absolute deviation tells; noise reaches five among millions of pixels. And what is so where it hangs together with
 * such. */
static const float surely = 8, possibly = 3, deviation_of_median = 1.4826f;

/* Of mean levels; below 0 if the pictures' edge is no background. */
typedef struct thresholds {
    float sure, possible;
} thresholds;

static bool is_edge(const img *level, size_t pixel)
{
    int x = (int)(pixel % (size_t)level->width), y = (int)(pixel / (size_t)level->width);
    int wide = (int)(edge_width * (level->width > level->height ? level->width : level->height));
    if (wide < LEAST_EDGE) wide = LEAST_EDGE;
    return x < wide || y < wide || x >= level->width - wide || y >= level->height - wide;
}

/* At most SAMPLE levels of the edge or of all pixels, sorted. */
static size_t sorted_sample(const img *level, bool edge, float *sample)
{
    size_t pixels = (size_t)level->width * (size_t)level->height, all = 0, count = 0;
    for (size_t p = 0; p < pixels; p++)
        all += !edge || is_edge(level, p);
    size_t step = all / SAMPLE + 1;
    all = 0;
    for (size_t p = 0; p < pixels; p++)
        if ((!edge || is_edge(level, p)) && all++ % step == 0) sample[count++] = level->data[p];
    qsort(sample, count, sizeof *sample, pst_ascending);
    return count;
}

/* sample: room for SAMPLE. */
static thresholds edge_thresholds(const img *level, float *sample)
{
    size_t count = sorted_sample(level, false, sample);
    float limit = dark * sample[(size_t)(bright * (double)(count - 1))];
    count = sorted_sample(level, true, sample);
    float median = sample[count / 2];
    if (median >= limit) return (thresholds){-1, -1};
    for (size_t i = 0; i < count; i++)
        sample[i] = fabsf(sample[i] - median);
    qsort(sample, count, sizeof *sample, pst_ascending);
    float deviation = deviation_of_median * sample[count / 2];
    return (thresholds){median + surely * deviation, median + possibly * deviation};
}

/* Leaves in the mask what is above the higher threshold, and what is above the lower one and hangs together with that.
 * waiting: room for all pixels. */
static void keep_above(const img *level, thresholds t, size_t *waiting, img *mask)
{
    const size_t width = (size_t)mask->width, pixels = width * (size_t)mask->height;
    enum { POSSIBLE = 2 };
    size_t count = 0;
    for (size_t p = 0; p < pixels; p++) {
        bool sure = mask->data[p] > 0 && level->data[p] > t.sure;
        mask->data[p] = sure ? 1 : mask->data[p] > 0 && level->data[p] > t.possible ? POSSIBLE : 0;
        if (sure) waiting[count++] = p;
    }
    while (count > 0) {
        size_t p = waiting[--count], x = p % width;
        const size_t beside[] = {x > 0 ? p - 1 : p, x + 1 < width ? p + 1 : p, p >= width ? p - width : p,
                                 p + width < pixels ? p + width : p};
        for (size_t k = 0; k < sizeof beside / sizeof *beside; k++) {
            if (mask->data[beside[k]] < POSSIBLE) continue;
            mask->data[beside[k]] = 1;
            waiting[count++] = beside[k];
        }
    }
    for (size_t p = 0; p < pixels; p++)
        if (mask->data[p] > 1) mask->data[p] = 0;
}

/* What is lit at all into the mask, and the mean over pictures and channels. */
static void look(pst_capture *c, img *level)
{
    size_t pixels = (size_t)c->width * (size_t)c->height, channels = (size_t)c->channels;
    const uint16_t least = (uint16_t)(PST_BLACK * 65535);
    const float share = 1 / (65535 * (float)channels * (float)c->count);
    for (int i = 0; i < c->count; i++) {
        for (size_t p = 0; p < pixels * channels; p++) {
            level->data[p / channels] += share * c->picture[i][p];
            if (c->picture[i][p] > least) c->mask.data[p / channels] = 1;
        }
    }
}

status pst_capture_find_mask(pst_capture *c)
{
    img level;
    status s = img_new(&c->mask, c->width, c->height, 1);
    if (s != OK) return s;
    s = img_new(&level, c->width, c->height, 1);
    float *sample = malloc(SAMPLE * sizeof *sample);
    size_t *waiting = malloc((size_t)c->width * (size_t)c->height * sizeof *waiting);
    if (s == OK && (!sample || !waiting)) s = fail(ERROR_MEMORY, "no memory to find the object");
    if (s == OK) {
        look(c, &level);
        keep_above(&level, edge_thresholds(&level, sample), waiting, &c->mask);
    }
    free(sample);
    free(waiting);
    img_free(&level);
    if (s != OK) img_free(&c->mask);
    return s;
}
