/* SPDX-License-Identifier: MIT */
#include "sequence/sequence_blend.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "base/vec.h"
#include "image/resize.h"
#include "sequence/sequence_exposure.h"

enum { RADIUS = 2, WINDOW = (2 * RADIUS + 1) * (2 * RADIUS + 1), MOST_SAMPLES = 16384 };
/* A pixel is the same up to this many medians of the differences, and another from twice that on; within these bounds
 * of encoded values, for means over a window and for single pixels. */
static const float MEDIANS = 4;
static const float LEAST_MEAN = 0.008f, MOST_MEAN = 0.02f, LEAST_SINGLE = 0.03f, MOST_SINGLE = 0.1f;

void sequence_history_free(sequence_history *h)
{
    img *images[] = {&h->albedo, &h->normal,         &h->roughness, &h->depth,
                     &h->mask,   &h->reconstruction, &h->seen,      &h->weight};
    for (size_t i = 0; i < sizeof images / sizeof *images; i++)
        img_free(images[i]);
    *h = (sequence_history){.albedo = {0}};
}

status sequence_history_move(sequence_history *h, sequence_shift by)
{
    img *images[] = {&h->albedo, &h->normal,         &h->roughness, &h->depth,
                     &h->mask,   &h->reconstruction, &h->seen,      &h->weight};
    status s = OK;
    for (size_t i = 0; i < sizeof images / sizeof *images && s == OK; i++)
        s = sequence_move(images[i], by);
    return s;
}

/* ---- where the picture is the same ---- */

static float largest_difference(const img *a, const img *b, size_t pixel)
{
    float most = 0;
    for (size_t c = 0; c < 3; c++)
        most = fmaxf(most, fabsf(a->data[3 * pixel + c] - b->data[3 * pixel + c]));
    return most;
}

/* Returns the median difference within the mask. */
static status median_difference(const img *a, const img *b, const img *mask, float *median)
{
    const size_t pixels = (size_t)mask->width * (size_t)mask->height;
    float *values = malloc(sizeof(float) * MOST_SAMPLES);
    if (!values) return fail(MERLIN_NO_MEMORY, "no memory to compare frames");
    size_t covered = 0, count = 0, seen = 0;
    for (size_t i = 0; i < pixels; i++)
        covered += mask->data[i] >= 0.5f;
    const size_t step = covered / MOST_SAMPLES + 1;
    for (size_t i = 0; i < pixels; i++)
        if (mask->data[i] >= 0.5f && seen++ % step == 0) values[count++] = largest_difference(a, b, i);
    *median = sequence_median(values, count);
    free(values);
    return OK;
}

/* Returns 1 up to `limit`, 0 from twice that on. */
static float fall(float difference, float limit)
{
    return clamp(2 - difference / limit, 0, 1);
}

/* Multiplies `same` by how little the pictures differ; they may be sums over this many pixels. */
static status judge(const img *a, const img *b, const img *mask, const float bounds[2], int sums, img *same,
                    float *median)
{
    status s = median_difference(a, b, mask, median);
    *median /= (float)sums;
    const float limit = clamp(MEDIANS * *median, bounds[0], bounds[1]) * (float)sums;
    const size_t pixels = (size_t)mask->width * (size_t)mask->height;
    for (size_t i = 0; s == OK && i < pixels; i++)
        same->data[i] *= fall(largest_difference(a, b, i), limit);
    return s;
}

/* Lets what is the same end softly where something else begins, so that no seam shows. */
static status soften(img *same)
{
    enum { SEAM = 4 };
    img around = {0};
    status s = img_copy(&around, same);
    if (s == OK) s = img_box_sums(&around, SEAM);
    for (int y = 0; s == OK && y < same->height; y++)
        for (int x = 0; x < same->width; x++) {
            const int left = x < SEAM ? x : SEAM, right = same->width - 1 - x < SEAM ? same->width - 1 - x : SEAM;
            const int above = y < SEAM ? y : SEAM, below = same->height - 1 - y < SEAM ? same->height - 1 - y : SEAM;
            const float mean = *img_at(&around, x, y) / (float)((left + right + 1) * (above + below + 1));
            float *value = img_at(same, x, y);
            *value = fminf(*value, clamp(2 * mean - 1, 0, 1));
        }
    img_free(&around);
    return s;
}

/* Trusts what is the same less where little of the object is: then it is so by chance, as what is dark before and after
 * a lamp has moved. */
static void distrust(const img *mask, img *same)
{
    static const float LITTLE = 0.2f, ENOUGH = 0.6f;
    double sum = 0, count = 0;
    for (size_t i = 0; i < img_value_count(same); i++) {
        if (mask->data[i] < 0.5f) continue;
        sum += (double)same->data[i];
        count++;
    }
    const float mean = count > 0 ? (float)(sum / count) : 1;
    const float trust = clamp((mean - LITTLE) / (ENOUGH - LITTLE), 0, 1);
    for (size_t i = 0; i < img_value_count(same) && trust < 1; i++)
        same->data[i] *= trust;
}

status sequence_sameness(const sequence_history *h, const img *now, img *same, float *difference)
{
    img before = {0}, after = {0};
    float mean;
    status s = img_new(same, now->width, now->height, 1);
    for (size_t i = 0; s == OK && i < img_value_count(same); i++)
        same->data[i] = 1;
    if (s == OK) s = judge(&h->seen, now, &h->mask, (const float[2]){LEAST_SINGLE, MOST_SINGLE}, 1, same, difference);
    if (s == OK) s = img_copy(&before, &h->seen);
    if (s == OK) s = img_copy(&after, now);
    if (s == OK) s = img_box_sums(&before, RADIUS);
    if (s == OK) s = img_box_sums(&after, RADIUS);
    if (s == OK) s = judge(&before, &after, &h->mask, (const float[2]){LEAST_MEAN, MOST_MEAN}, WINDOW, same, &mean);
    if (s == OK) s = soften(same);
    if (s == OK) distrust(&h->mask, same);
    img_free(&before);
    img_free(&after);
    if (s != OK) img_free(same);
    return s;
}

/* ---- the average ---- */

/* Replaces values of one pixel by the mean with those of before, where both are there, else by what is there. */
static void mean_of(const img *before, img *now, size_t pixel, float kept, bool was, bool is)
{
    const size_t channels = (size_t)now->channels;
    for (size_t c = 0; c < channels; c++) {
        const float old = before->data[channels * pixel + c];
        float *value = now->data + channels * pixel + c;
        if (was && is)
            *value = kept * old + (1 - kept) * *value;
        else if (was)
            *value = old;
    }
}

/* Copies a pixel's values into the history. */
static void keep(img *average, const img *now, size_t pixel)
{
    const size_t channels = (size_t)now->channels;
    for (size_t c = 0; c < channels; c++)
        average->data[channels * pixel + c] = now->data[channels * pixel + c];
}

static void clear(img *map, size_t pixel)
{
    const size_t channels = (size_t)map->channels;
    for (size_t c = 0; c < channels; c++)
        map->data[channels * pixel + c] = 0;
}

/* Returns the coverage to show of an average: what has just appeared, or goes, is not shown until it is more than a
 * little; the outline, where all frames agree on a little, is. */
static float shown(float average, float own)
{
    const float little = 0.25f, apart = 0.1f;
    if (average < little && fabsf(own - average) > apart) return 0;
    return average < 0.05f ? 0 : average > 0.95f ? 1 : average; /* as mask_clean has it */
}

/* Averages all maps of a pixel; kept: the share of the history, which is updated. */
static void blend_pixel(sequence_history *h, size_t i, float kept, bool keep_mask, merlin_maps *maps)
{
    const float old = h->mask.data[i], own = maps->mask.data[i];
    const bool was = old > 0, is = own > 0;
    const float average = keep_mask ? own : kept * old + (1 - kept) * own;
    const float cover = keep_mask ? own : shown(average, own);
    img *images[] = {&maps->albedo, &maps->roughness, &maps->depth, &maps->normal};
    img *averages[] = {&h->albedo, &h->roughness, &h->depth, &h->normal};
    h->mask.data[i] = average < 0.02f ? 0 : average;
    maps->mask.data[i] = cover;
    for (size_t k = 0; k < 4; k++) {
        mean_of(averages[k], images[k], i, kept, was, is);
        if (images[k] == &maps->normal)
            vec3_put(vec3_normalize(vec3_of(maps->normal.data + 3 * i)), maps->normal.data + 3 * i);
        keep(averages[k], images[k], i);
        if (cover == 0) clear(images[k], i);
    }
    mean_of(&h->reconstruction, &maps->reconstruction, i, kept, true, true);
    keep(&h->reconstruction, &maps->reconstruction, i);
    if (cover == 0) clear(&maps->reconstruction, i);
}

static status renew(img *average, const img *with)
{
    img_free(average);
    return img_copy(average, with);
}

static status remember(sequence_history *h, const merlin_maps *maps)
{
    status s = renew(&h->albedo, &maps->albedo);
    if (s == OK) s = renew(&h->normal, &maps->normal);
    if (s == OK) s = renew(&h->roughness, &maps->roughness);
    if (s == OK) s = renew(&h->depth, &maps->depth);
    if (s == OK) s = renew(&h->mask, &maps->mask);
    return s == OK ? renew(&h->reconstruction, &maps->reconstruction) : s;
}

static status begin(sequence_history *h, const img *now, const merlin_maps *maps)
{
    status s = remember(h, maps);
    if (s == OK) s = renew(&h->seen, now);
    img_free(&h->weight);
    if (s == OK) s = img_new(&h->weight, now->width, now->height, 1);
    for (size_t i = 0; s == OK && i < img_value_count(&h->weight); i++)
        h->weight.data[i] = 1;
    return s;
}

/* Puts the frame's own pixels, multiplied by the mask, in the place of its photograph's. */
static void cover_photo(const img *now, float unit, merlin_maps *maps)
{
    for (size_t i = 0; i < img_value_count(&maps->photo); i++)
        maps->photo.data[i] = maps->mask.data[i / 3] * now->data[i] * now->data[i] / unit;
}

status sequence_blend(sequence_history *h, const img *now, const img *same, int most, bool keep_mask, merlin_maps *maps,
                      float *kept)
{
    *kept = 0;
    if (!same) return begin(h, now, maps);
    size_t covered = 0;
    double kept_pixels = 0;
    for (size_t i = 0; i < img_value_count(same); i++) {
        const float old = same->data[i] * fminf(h->weight.data[i], (float)(most - 1)), share = old / (old + 1);
        h->weight.data[i] = old + 1;
        for (size_t c = 0; c < 3; c++)
            h->seen.data[3 * i + c] = share * h->seen.data[3 * i + c] + (1 - share) * now->data[3 * i + c];
        if (!(maps->mask.data[i] > 0) && !(h->mask.data[i] > 0)) continue;
        blend_pixel(h, i, share, keep_mask, maps);
        covered += maps->mask.data[i] >= 0.5f;
        if (maps->mask.data[i] >= 0.5f) kept_pixels += (double)same->data[i];
    }
    *kept = covered ? (float)(kept_pixels / (double)covered) : 0;
    cover_photo(now, h->unit, maps);
    return OK;
}
