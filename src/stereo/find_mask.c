/* The mask of a capture that has none. In the object is what some light brings above black and, where the picture's
 * edge is dark, what is brighter than that edge in the root mean square: noise and black cloth are no object. Specks go
 * then, and small holes, of dark paint, are filled. */
#include <math.h>
#include <stdlib.h>

#include "base/parallel.h"
#include "stereo/capture_parts.h"
#include "stereo/pixel_fit.h"

enum { LEAST_EDGE = 2, SAMPLE = 65536 };
/* Width of the edge, in the picture's shorter side. */
static const double edge_width = 0.02;
/* The edge is background where its median is less than the first share of what 199 of 200 pixels stay below: an object
 * must have one pixel in 200. */
static const float dark = 0.05f;
static const double bright = 0.995;
/* What is surely no background: above the edge's median by so many of its standard deviations, which its median
 * absolute deviation tells; noise reaches five among millions of pixels. And what is so where it hangs together with
 * such. */
static const float surely = 8, possibly = 3, deviation_of_median = 1.4826f;
/* The deviation is no less than this share of the median: most of a cloth may have one and the same of 256 codes. */
static const float least_deviation = 0.05f;

/* Of the object's pixels: separate pieces of less are specks, holes of less are dark paint. */
static const double small = 0.01;

/* Of levels; below 0 if the pictures' edge is no background. */
typedef struct thresholds {
    float sure, possible;
} thresholds;

static int edge_pixels(const img *level)
{
    int wide = (int)(edge_width * (level->width < level->height ? level->width : level->height));
    return wide < LEAST_EDGE ? LEAST_EDGE : wide;
}

/* At most SAMPLE levels, sorted: of all pixels or, if wide > 0, of those this near to the picture's edge. */
static size_t sorted_sample(const img *level, int wide, float *sample)
{
    size_t count = 0, seen = 0, pixels = (size_t)level->width * (size_t)level->height;
    const size_t step = (pixels / SAMPLE + 1) | 1; /* odd, so as not to keep to some columns */
    for (int y = 0; y < level->height; y++) {
        bool inside = wide > 0 && y >= wide && y < level->height - wide;
        for (int x = 0; x < level->width; x++) {
            if (inside && x >= wide && x < level->width - wide) x = level->width - wide;
            if (seen++ % step == 0) sample[count++] = *img_at(level, x, y);
        }
    }
    qsort(sample, count, sizeof *sample, pst_ascending);
    return count;
}

/* sample: room for SAMPLE. */
static thresholds edge_thresholds(const img *level, float *sample)
{
    size_t count = sorted_sample(level, 0, sample);
    float limit = dark * sample[(size_t)(bright * (double)(count - 1))];
    count = sorted_sample(level, edge_pixels(level), sample);
    float median = sample[count / 2];
    if (median >= limit) return (thresholds){-1, -1};
    for (size_t i = 0; i < count; i++)
        sample[i] = fabsf(sample[i] - median);
    qsort(sample, count, sizeof *sample, pst_ascending);
    float deviation = fmaxf(deviation_of_median * sample[count / 2], least_deviation * median);
    return (thresholds){median + surely * deviation, median + possibly * deviation};
}

/* Leaves in the mask what is above the higher threshold, and what is above the lower one and hangs together with that.
 * waiting: room for all pixels. */
static void keep_above(const img *level, thresholds t, uint32_t *waiting, img *mask)
{
    const size_t width = (size_t)mask->width, pixels = width * (size_t)mask->height;
    enum { POSSIBLE = 2 };
    size_t count = 0;
    for (size_t p = 0; p < pixels; p++) {
        bool sure = mask->data[p] > 0 && level->data[p] > t.sure;
        mask->data[p] = sure ? 1 : mask->data[p] > 0 && level->data[p] > t.possible ? POSSIBLE : 0;
        if (sure) waiting[count++] = (uint32_t)p;
    }
    while (count > 0) {
        size_t p = waiting[--count], x = p % width;
        const size_t beside[] = {x > 0 ? p - 1 : p, x + 1 < width ? p + 1 : p, p >= width ? p - width : p,
                                 p + width < pixels ? p + width : p};
        for (size_t k = 0; k < sizeof beside / sizeof *beside; k++) {
            if (mask->data[beside[k]] < POSSIBLE) continue;
            mask->data[beside[k]] = 1;
            waiting[count++] = (uint32_t)beside[k];
        }
    }
    for (size_t p = 0; p < pixels; p++)
        if (mask->data[p] > 1) mask->data[p] = 0;
}

/* What has been looked at has this added to it. */
enum { SEEN = 2 };

/* The pixels that hang together with this one, into piece; whether one is at the picture's edge. */
static size_t gather(img *mask, size_t from, uint32_t *piece, bool *at_edge)
{
    const size_t width = (size_t)mask->width, pixels = width * (size_t)mask->height;
    const float kind = mask->data[from];
    size_t count = 0;
    *at_edge = false;
    mask->data[from] += SEEN;
    piece[count++] = (uint32_t)from;
    for (size_t i = 0; i < count; i++) {
        size_t p = piece[i], x = p % width;
        *at_edge |= x == 0 || x + 1 == width || p < width || p + width >= pixels;
        const size_t beside[] = {x > 0 ? p - 1 : p, x + 1 < width ? p + 1 : p, p >= width ? p - width : p,
                                 p + width < pixels ? p + width : p};
        for (size_t k = 0; k < sizeof beside / sizeof *beside; k++) {
            if (mask->data[beside[k]] != kind) continue;
            mask->data[beside[k]] += SEEN;
            piece[count++] = (uint32_t)beside[k];
        }
    }
    return count;
}

/* Specks go, small holes are filled. piece: room for all pixels. */
static void settle_small(img *mask, uint32_t *piece)
{
    const size_t pixels = (size_t)mask->width * (size_t)mask->height;
    size_t inside = 0;
    for (size_t p = 0; p < pixels; p++)
        inside += mask->data[p] > 0;
    for (size_t p = 0; p < pixels; p++) {
        bool at_edge, hole = mask->data[p] == 0;
        if (mask->data[p] >= SEEN) continue;
        size_t count = gather(mask, p, piece, &at_edge);
        if ((double)count >= small * (double)inside || (hole && at_edge)) continue;
        for (size_t i = 0; i < count; i++)
            mask->data[piece[i]] = hole ? SEEN + 1 : SEEN;
    }
    for (size_t p = 0; p < pixels; p++)
        mask->data[p] -= SEEN;
}

typedef struct looking {
    pst_capture *capture;
    img *level;
} looking;

/* What is lit at all into the mask, and the mean square over pictures and channels: dark glossy objects are bright in
 * few pictures. */
static void look_at_part(const looking *job, size_t begin, size_t end)
{
    const pst_capture *c = job->capture;
    const size_t channels = (size_t)c->channels;
    const uint16_t least = (uint16_t)(PST_BLACK * 65535);
    const float share = 1 / (65535.0f * 65535.0f * (float)channels * (float)c->count);
    for (int k = 0; k < c->count; k++) {
        for (size_t p = begin; p < end; p++) {
            const uint16_t *value = c->picture[k] + p * channels;
            float sum = 0;
            for (size_t i = 0; i < channels; i++) {
                sum += (float)value[i] * (float)value[i];
                if (value[i] > least) c->mask.data[p] = 1;
            }
            job->level->data[p] += share * sum;
        }
    }
}

/* By parts whose mask and level stay in the cache while pictures pass. */
static void look(void *context, size_t begin, size_t end)
{
    enum { PART = 8192 };
    for (size_t p = begin; p < end; p += PART)
        look_at_part(context, p, p + PART < end ? p + PART : end);
}

status pst_capture_find_mask(pst_capture *c)
{
    img level;
    const size_t pixels = (size_t)c->width * (size_t)c->height;
    status s = img_new(&c->mask, c->width, c->height, 1);
    if (s != OK) return s;
    s = img_new(&level, c->width, c->height, 1);
    float *sample = malloc(SAMPLE * sizeof *sample);
    uint32_t *waiting = malloc(pixels * sizeof *waiting);
    if (s == OK && (!sample || !waiting)) s = fail(ERROR_MEMORY, "no memory to find the object");
    if (s == OK) {
        parallel_blocks(pixels, look, &(looking){c, &level});
        for (size_t p = 0; p < pixels; p++)
            level.data[p] = sqrtf(level.data[p]);
        const thresholds t = edge_thresholds(&level, sample);
        keep_above(&level, t, waiting, &c->mask);
        if (t.sure >= 0) settle_small(&c->mask, waiting);
    }
    free(sample);
    free(waiting);
    img_free(&level);
    if (s != OK) img_free(&c->mask);
    return s;
}
