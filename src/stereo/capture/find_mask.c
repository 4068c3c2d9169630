/* SPDX-License-Identifier: MIT */
/* Finds the mask of a capture that has none. The object consists of pixels that some light raises above black and, if
 * the picture's edge is dark, whose root mean square is brighter than that edge, which excludes noise and black cloth.
 * Then specks are removed, and small holes, which are dark paint, filled. docs/notes/masks.md states how good the
 * result is. */
#include <math.h>
#include <stdlib.h>

#include "base/number.h"
#include "base/parallel.h"
#include "stereo/capture/capture_parts.h"

enum { LEAST_EDGE = 2, SAMPLE = 65536 };
/* Width of the edge, as a share of the picture's shorter side. */
static const double edge_width = 0.02;
/* The edge is background if its median is less than this share of the value that 199 of 200 pixels stay below, as an
 * object has at least one pixel in 200. */
static const float dark = 0.05f;
static const double bright = 0.995;
/* Thresholds above the edge's median, in standard deviations by its median absolute deviation: pixels above the first
 * are certainly no background, as noise reaches five among millions of pixels; pixels above the second are object if
 * they are connected with such. */
static const float surely = 8, possibly = 3, deviation_of_median = 1.4826f;
/* Least deviation, as a share of the median: most of a cloth may have the same one of 256 codes. */
static const float least_deviation = 0.05f;

/* Share of the object's pixels: smaller separate pieces are specks, smaller holes dark paint. */
static const double small = 0.01;

/* Thresholds of levels; below 0 if the pictures' edge is not background. */
typedef struct thresholds {
    float sure, possible;
} thresholds;

static int edge_pixels(const img *level)
{
    int wide = (int)(edge_width * (level->width < level->height ? level->width : level->height));
    return wide < LEAST_EDGE ? LEAST_EDGE : wide;
}

/* Samples at most SAMPLE levels, sorted: of all pixels or, if wide > 0, of those this close to the picture's edge. */
static size_t sorted_sample(const img *level, int wide, float *sample)
{
    size_t count = 0, seen = 0, pixels = (size_t)level->width * (size_t)level->height;
    const size_t step = (pixels / SAMPLE + 1) | 1; /* odd, so that samples are not all in a few columns */
    for (int y = 0; y < level->height; y++) {
        bool inside = wide > 0 && y >= wide && y < level->height - wide;
        for (int x = 0; x < level->width; x++) {
            if (inside && x >= wide && x < level->width - wide) x = level->width - wide;
            if (seen++ % step == 0) sample[count++] = *img_at(level, x, y);
        }
    }
    qsort(sample, count, sizeof *sample, number_ascending);
    return count;
}

/* Finds the thresholds; sample: room for SAMPLE. */
static thresholds edge_thresholds(const img *level, float *sample)
{
    size_t count = sorted_sample(level, 0, sample);
    float limit = dark * sample[(size_t)(bright * (double)(count - 1))];
    count = sorted_sample(level, edge_pixels(level), sample);
    float median = sample[count / 2];
    if (median >= limit) return (thresholds){-1, -1};
    for (size_t i = 0; i < count; i++)
        sample[i] = fabsf(sample[i] - median);
    qsort(sample, count, sizeof *sample, number_ascending);
    float deviation = fmaxf(deviation_of_median * sample[count / 2], least_deviation * median);
    return (thresholds){median + surely * deviation, median + possibly * deviation};
}

/* Added to pixels that have been visited. */
enum { SEEN = 2 };

static void forget_seen(img *mask)
{
    for (size_t p = 0; p < img_value_count(mask); p++)
        if (mask->data[p] >= SEEN) mask->data[p] -= SEEN;
}

/* Collects the pixels connected with this one in piece. */
static size_t gather(img *mask, size_t from, uint32_t *piece)
{
    const float kind = mask->data[from];
    size_t count = 0;
    mask->data[from] += SEEN;
    piece[count++] = (uint32_t)from;
    for (size_t i = 0; i < count; i++) {
        size_t beside[4];
        int sides = img_beside(mask->width, mask->height, piece[i], beside);
        for (int k = 0; k < sides; k++) {
            if (mask->data[beside[k]] != kind) continue;
            mask->data[beside[k]] += SEEN;
            piece[count++] = (uint32_t)beside[k];
        }
    }
    return count;
}

/* Keeps the pixels above the lower threshold that are connected with ones above the higher threshold. piece: room for
 * all pixels. */
static void keep_above(const img *level, thresholds t, uint32_t *piece, img *mask)
{
    const size_t pixels = img_value_count(mask);
    for (size_t p = 0; p < pixels; p++)
        if (!(level->data[p] > t.possible)) mask->data[p] = 0;
    for (size_t p = 0; p < pixels; p++) {
        if (mask->data[p] != 1) continue;
        size_t count = gather(mask, p, piece);
        bool sure = false;
        for (size_t i = 0; i < count && !sure; i++)
            sure = level->data[piece[i]] > t.sure;
        for (size_t i = 0; i < count && !sure; i++)
            mask->data[piece[i]] = 0;
    }
    forget_seen(mask);
}

static bool reaches_edge(const img *mask, const uint32_t *piece, size_t count)
{
    size_t beside[4];
    for (size_t i = 0; i < count; i++)
        if (img_beside(mask->width, mask->height, piece[i], beside) < 4) return true;
    return false;
}

/* Removes specks and fills small holes. piece: room for all pixels. */
static void settle_small(img *mask, uint32_t *piece)
{
    const size_t pixels = img_value_count(mask);
    size_t inside = 0;
    for (size_t p = 0; p < pixels; p++)
        inside += mask->data[p] > 0;
    for (size_t p = 0; p < pixels; p++) {
        if (mask->data[p] >= SEEN) continue;
        bool hole = mask->data[p] == 0;
        size_t count = gather(mask, p, piece);
        if ((double)count >= small * (double)inside || (hole && reaches_edge(mask, piece, count))) continue;
        for (size_t i = 0; i < count; i++)
            mask->data[piece[i]] = hole ? SEEN + 1 : SEEN;
    }
    forget_seen(mask);
}

typedef struct scanning {
    merlin_capture *capture;
    img *level;
} scanning;

/* Marks lit pixels in the mask, and computes the mean square over pictures and channels; dark glossy objects are bright
 * in few pictures. */
static void scan_part(const scanning *job, size_t begin, size_t end)
{
    const merlin_capture *c = job->capture;
    const size_t channels = (size_t)c->channels;
    const uint16_t least = (uint16_t)(PST_BLACK * 65535);
    const float share = 1 / (65535.0f * 65535.0f * (float)channels * (float)c->count);
    for (int k = 0; k < c->count; k++) {
        for (size_t p = begin; p < end; p++) {
            float sum = 0;
            for (size_t i = 0; i < channels; i++) {
                const uint16_t code = pst_code(&c->picture[k], p * channels + i);
                sum += (float)code * (float)code;
                if (code > least) c->mask.data[p] = 1;
            }
            job->level->data[p] += share * sum;
        }
    }
}

/* Processes parts small enough for their mask and level to stay in the cache over all pictures. */
static void scan(void *context, size_t begin, size_t end)
{
    enum { PART = 8192 };
    for (size_t p = begin; p < end; p += PART)
        scan_part(context, p, p + PART < end ? p + PART : end);
}

status pst_capture_find_mask(merlin_capture *c)
{
    img level;
    const size_t pixels = (size_t)c->width * (size_t)c->height;
    status s = img_new(&c->mask, c->width, c->height, 1);
    if (s != OK) return s;
    s = img_new(&level, c->width, c->height, 1);
    float *sample = malloc(SAMPLE * sizeof *sample);
    uint32_t *piece = malloc(pixels * sizeof *piece);
    if (s == OK && (!sample || !piece)) s = fail(MERLIN_NO_MEMORY, "no memory to find the object");
    if (s == OK) {
        parallel_blocks(pixels, scan, &(scanning){c, &level});
        for (size_t p = 0; p < pixels; p++)
            level.data[p] = sqrtf(level.data[p]);
        const thresholds t = edge_thresholds(&level, sample);
        if (t.sure >= 0) {
            keep_above(&level, t, piece, &c->mask);
            settle_small(&c->mask, piece);
        }
    }
    free(sample);
    free(piece);
    img_free(&level);
    if (s != OK) img_free(&c->mask);
    return s;
}
