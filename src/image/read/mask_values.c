/* SPDX-License-Identifier: MIT */
#include "image/read/mask_values.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"

/* Most values that are distinguished, the size of their hash table, and most channels of a mask. */
enum { MOST_VALUES = 256, SLOTS = 1024, MOST_CHANNELS = 3 };

/* Least share of a value's pixels that have only their own value around them, and least share of the picture, for the
 * value to be an area's rather than an edge's or noise. */
static const double least_inside = 0.4, least_share = 0.002;
enum { LEAST_AREA = 9 };

/* Largest distance of values that lossy files make of one value, and smallest distance of two intended ones. */
static const float scatter = 24 / 255.0f, least_contrast = 16 / 255.0f;

/* Least share of the pixels that lie near a group's mean, as noise would, for two groups to count as two values. */
static const double least_near = 0.85;
static const float noise = 0.25f;

/* Greatest share of what a mask shows that lies in the middle between nothing and everything, as a photograph's pixels
 * do and those of wide soft edges do not. */
static const double most_between = 0.5;

/* A soft edge's values are passed in steps of this at most, from and to values beyond them, but for few of the pixels
 * around; they are as frequent as the values about them, or near one of the ends. */
static const float most_step = 6.5f / 255, near_end = 0.1f, about = 4.5f / 255;
static const double few = 0.05, least_beyond = 0.02, frequent = 3;
/* Brightness to either side of which a soft mask reaches. */
static const float soft_dark = 0.25f, soft_bright = 0.75f;

/* Floats above this have a unit of their own. */
static const float beyond_white = 1.5f;

typedef struct value {
    float sample[MOST_CHANNELS];
    float brightness;
    size_t count, inside; /* pixels, and those of them with no other value around them */
    size_t darker, brighter,
        other; /* pixels around it that are so by a step at most, and all others of another value */
} value;

typedef struct tally {
    value at[MOST_VALUES];
    uint16_t slot[SLOTS]; /* 1 + an index into at, or 0 */
    size_t count;
    bool many; /* more values than the table holds: a soft mask, or a photograph */
} tally;

static float brightness_of(const float *sample, int channels)
{
    float sum = 0;
    for (int c = 0; c < channels; c++)
        sum += sample[c];
    return sum / (float)channels;
}

static bool is_same(const float *a, const float *b, int channels)
{
    for (int c = 0; c < channels; c++)
        if (a[c] != b[c]) return false;
    return true;
}

static size_t hash(const float *sample, int channels)
{
    uint64_t h = 0;
    for (int c = 0; c < channels; c++) {
        float same_zero = sample[c] + 0.0f; /* -0 equals 0, but has other bits */
        uint32_t bits;
        memcpy(&bits, &same_zero, sizeof bits);
        h = (h ^ bits) * 0x9e3779b97f4a7c15u;
    }
    return (size_t)(h >> 40) % SLOTS;
}

/* Finds or adds a value; returns NULL and sets many if the table is full. */
static value *find_value(tally *t, const float *sample, int channels)
{
    size_t slot = hash(sample, channels);
    for (; t->slot[slot]; slot = (slot + 1) % SLOTS)
        if (is_same(t->at[t->slot[slot] - 1].sample, sample, channels)) return &t->at[t->slot[slot] - 1];
    t->many = t->count == MOST_VALUES;
    if (t->many) return NULL;
    value *v = &t->at[t->count++];
    t->slot[slot] = (uint16_t)t->count;
    *v = (value){.brightness = brightness_of(sample, channels)};
    memcpy(v->sample, sample, (size_t)channels * sizeof *sample);
    return v;
}

/* Counts a pixel by those around it. */
static void count_pixel(const img *m, size_t pixel, value *v)
{
    size_t beside[4];
    const int count = img_beside(m->width, m->height, pixel, beside);
    bool inside = true;
    for (int i = 0; i < count; i++) {
        const float *around = m->data + beside[i] * (size_t)m->channels;
        if (is_same(v->sample, around, m->channels)) continue;
        const float step = brightness_of(around, m->channels) - v->brightness;
        inside = false;
        v->darker += step < 0 && step >= -most_step;
        v->brighter += step > 0 && step <= most_step;
        v->other += step == 0 || fabsf(step) > most_step;
    }
    v->count++;
    v->inside += inside;
}

static void count_values(const img *m, tally *t)
{
    const size_t pixels = (size_t)m->width * (size_t)m->height;
    value *last = NULL;
    for (size_t i = 0; i < pixels; i++) {
        const float *sample = m->data + i * (size_t)m->channels;
        if (!last || !is_same(last->sample, sample, m->channels)) last = find_value(t, sample, m->channels);
        if (!last) return;
        count_pixel(m, i, last);
    }
}

/* ---- values with areas of their own ---- */

static int by_brightness(const void *a, const void *b)
{
    const value *v = a, *w = b;
    return (v->brightness > w->brightness) - (v->brightness < w->brightness);
}

static bool is_area(const value *v, size_t pixels)
{
    return v->count >= LEAST_AREA && (double)v->count >= least_share * (double)pixels &&
           (double)v->inside >= least_inside * (double)v->count;
}

static bool is_soft(const tally *t)
{
    bool dark = false, bright = false;
    for (size_t i = 0; i < t->count; i++) {
        dark |= t->at[i].brightness < soft_dark;
        bright |= t->at[i].brightness >= soft_bright;
    }
    return dark && bright;
}

/* Tells whether a value has far more pixels than those about it: an area amid soft edges. */
static bool stands_out(const tally *t, const value *v)
{
    double sum = 0;
    for (size_t i = 0; i < t->count; i++)
        if (fabsf(t->at[i].brightness - v->brightness) <= about) sum += (double)t->at[i].count;
    const double others = (sum - (double)v->count) / (2 * (int)(255 * about));
    return (double)v->count > frequent * others;
}

/* Tells whether a value is a step of a wide soft edge. */
static bool is_step(const tally *t, const value *v)
{
    const double all = (double)(v->darker + v->brighter + v->other);
    const bool at_end = v->brightness < near_end || v->brightness > 1 - near_end;
    return (double)v->other <= few * all && (double)v->darker >= least_beyond * all &&
           (double)v->brighter >= least_beyond * all && (at_end || !stands_out(t, v));
}

/* Keeps only the values of areas, the darkest first; in lossy files those that differ little are merged. */
static void keep_areas(tally *t, size_t pixels, bool lossy)
{
    const bool soft = is_soft(t);
    bool is_kept[MOST_VALUES];
    size_t kept = 0, joined = 0;
    for (size_t i = 0; i < t->count; i++)
        is_kept[i] = is_area(&t->at[i], pixels) && !(soft && is_step(t, &t->at[i]));
    for (size_t i = 0; i < t->count; i++)
        if (is_kept[i]) t->at[kept++] = t->at[i];
    qsort(t->at, kept, sizeof *t->at, by_brightness);
    float before = -1;
    for (size_t i = 0; i < kept; i++) {
        bool same = lossy && joined && t->at[i].brightness - before < scatter;
        before = t->at[i].brightness;
        if (!same) t->at[joined++] = t->at[i];
    }
    t->count = joined;
}

static bool are_codes(const tally *t, float white)
{
    for (size_t i = 0; i < t->count; i++)
        if (fabsf(t->at[i].brightness * white - roundf(t->at[i].brightness * white)) > 0.001f) return false;
    return true;
}

/* Writes the values as "0, 1, 2 of 255", or colours as "#800000". */
static void list_values(const tally *t, int channels, char *words, size_t size)
{
    enum { TOLD = 5 };
    float white = channels > 1 || are_codes(t, 255) ? 255 : 65535;
    size_t told = t->count < TOLD ? t->count : TOLD, at = 0;
    for (size_t i = 0; i < told; i++) {
        const float *v = t->at[i].sample;
        const char *between = i ? ", " : "";
        int n = channels > 1
                    ? snprintf(words + at, size - at, "%s#%02x%02x%02x", between, (unsigned)(v[0] * 255 + 0.5f),
                               (unsigned)(v[1] * 255 + 0.5f), (unsigned)(v[2] * 255 + 0.5f))
                    : snprintf(words + at, size - at, "%s%.0f", between, (double)(v[0] * white));
        at += (size_t)n;
    }
    if (told < t->count) at += (size_t)snprintf(words + at, size - at, ", ...");
    if (channels == 1) snprintf(words + at, size - at, " of %.0f", (double)white);
}

static status refuse_labels(const char *path, const tally *t, int channels)
{
    char words[128];
    list_values(t, channels, words, sizeof words);
    return fail(MERLIN_BAD_INPUT,
                "the mask %s has areas of %zu %s (%s): which is the object? Save it as white on black", path, t->count,
                channels > 1 ? "colours" : "values", words);
}

static status refuse_equals(const char *path, const tally *t, int channels)
{
    char words[128];
    list_values(t, channels, words, sizeof words);
    return fail(MERLIN_BAD_INPUT,
                "the mask %s has two colours that are equally bright (%s): which is the object? Save it as white on "
                "black",
                path, words);
}

/* ---- coverage ---- */

/* Maps values to coverage: 0 below low and 1 above high. */
static status spread(const img *values, float low, float high, img *mask)
{
    status s = img_new(mask, values->width, values->height, 1);
    size_t pixels = (size_t)values->width * (size_t)values->height, n = (size_t)values->channels;
    for (size_t i = 0; i < pixels && s == OK; i++) {
        float v = brightness_of(values->data + i * n, values->channels);
        mask->data[i] = clamp((v - low) / (high - low), 0, 1);
    }
    return s;
}

static status as_it_is(const img *values, img *mask)
{
    return spread(values, 0, 1, mask);
}

/* Maps the two values to coverage, which they are already if they are black and white, or nearly so. */
static status between(const img *values, float low, float high, img *mask)
{
    const bool plain = low <= near_end && high >= 1 - near_end;
    return plain ? as_it_is(values, mask) : spread(values, low, high, mask);
}

enum { BINS = 256 };

typedef struct groups {
    float low, high; /* means */
    double near;     /* share of the pixels near one of the means */
    float least, most;
} groups;

static size_t bin_of(const img *values, size_t pixel)
{
    float v = brightness_of(values->data + pixel * (size_t)values->channels, values->channels);
    return (size_t)(clamp(v, 0, 1) * (BINS - 1) + 0.5f);
}

/* Splits the histogram into the two groups with the largest between-class variance (Otsu 1979). */
static groups divide(const size_t bins[BINS])
{
    double total = 0, sum = 0, best = -1, below = 0, below_sum = 0;
    groups g = {.least = -1};
    for (int b = 0; b < BINS; b++) {
        total += (double)bins[b];
        sum += (double)bins[b] * b;
        if (!bins[b]) continue;
        g.most = (float)b / (BINS - 1);
        if (g.least < 0) g.least = g.most;
    }
    for (int b = 0; b + 1 < BINS; b++) {
        below += (double)bins[b];
        below_sum += (double)bins[b] * b;
        if (below == 0 || below == total) continue;
        double low = below_sum / below, high = (sum - below_sum) / (total - below);
        double apart = below * (total - below) * (high - low) * (high - low);
        if (apart <= best) continue;
        best = apart;
        g.low = (float)(low / (BINS - 1));
        g.high = (float)(high / (BINS - 1));
    }
    for (int b = 0; b < BINS; b++) {
        float v = (float)b / (BINS - 1), off = fminf(fabsf(v - g.low), fabsf(v - g.high));
        if (off <= noise * (g.high - g.low)) g.near += (double)bins[b] / total;
    }
    return g;
}

/* Computes coverage for pictures without two areas of one value each: two values with noise, or a soft mask. */
static status from_groups(const char *path, const img *values, img *mask)
{
    size_t bins[BINS] = {0}, pixels = (size_t)values->width * (size_t)values->height;
    for (size_t i = 0; i < pixels; i++)
        bins[bin_of(values, i)]++;
    groups g = divide(bins);
    bool across = g.least < 0.5f && g.most >= 0.5f, even = g.most - g.least < least_contrast;
    const bool apart = g.near >= least_near && g.high - g.low >= least_contrast, dark = g.least <= near_end;
    if (even || (g.low < 0.5f && g.high >= 0.5f && (dark || !apart))) return as_it_is(values, mask);
    if (apart) return spread(values, g.low, g.high, mask);
    if (across) return as_it_is(values, mask);
    return fail(MERLIN_BAD_INPUT,
                "the mask %s has no two values that stand out: they run from %.0f to %.0f of 255, all on one side of "
                "half white; save it as white on black",
                path, (double)(255 * g.least), (double)(255 * g.most));
}

/* Tells whether the areas make up the whole picture; noise around one value has no areas. */
static bool are_two(tally *t, bool lossy)
{
    if (t->many || t->count != 2 || (lossy && !(is_area(&t->at[0], 0) && is_area(&t->at[1], 0)))) return false;
    qsort(t->at, 2, sizeof *t->at, by_brightness);
    return true;
}

/* Refuses photographs, whose brightness would pass for coverage. */
static status check_decided(const char *path, const img *mask)
{
    const size_t pixels = img_value_count(mask);
    size_t between = 0, shown = 0;
    for (size_t i = 0; i < pixels; i++) {
        shown += mask->data[i] >= 0.25f;
        between += mask->data[i] >= 0.25f && mask->data[i] < 0.75f;
    }
    const double share = shown ? (double)between / (double)shown : 0;
    if (share <= most_between) return OK;
    return fail(MERLIN_BAD_INPUT,
                "the mask %s looks like a photograph: %.0f %% of what it shows is neither black nor white; save it as "
                "white on black",
                path, 100 * share);
}

static status from_tally(const char *path, const img *values, bool lossy, tally *t, img *mask)
{
    count_values(values, t);
    if (t->count == 1) return as_it_is(values, mask);
    bool two = are_two(t, lossy);
    if (!two && !t->many) keep_areas(t, (size_t)values->width * (size_t)values->height, lossy);
    if (t->many || t->count < 2) {
        status s = from_groups(path, values, mask);
        return s == OK ? check_decided(path, mask) : s;
    }
    float low = t->at[0].brightness, high = t->at[1].brightness;
    if (t->count > 2) return refuse_labels(path, t, values->channels);
    if (low == high) return refuse_equals(path, t, values->channels);
    if (two) return spread(values, low, high, mask);
    status s = between(values, low, high, mask);
    return s == OK ? check_decided(path, mask) : s;
}

static void scale(img *values)
{
    float most = 0;
    size_t count = img_value_count(values);
    for (size_t i = 0; i < count; i++)
        most = fmaxf(most, values->data[i] = fmaxf(values->data[i], 0));
    for (size_t i = 0; i < count && most >= beyond_white; i++)
        values->data[i] /= most;
}

bool mask_is_even(const img *values)
{
    size_t count = img_value_count(values);
    for (size_t i = 1; i < count; i++)
        if (values->data[i] != values->data[0]) return false;
    return true;
}

status mask_from_alpha(const img *alpha, img *mask)
{
    tally *t = calloc(1, sizeof *t);
    if (!t) return fail(MERLIN_NO_MEMORY, "no memory to read a mask");
    count_values(alpha, t);
    status s =
        are_two(t, false) ? spread(alpha, t->at[0].brightness, t->at[1].brightness, mask) : as_it_is(alpha, mask);
    free(t);
    return s;
}

status mask_from_values(const char *path, img *values, bool lossy, img *mask)
{
    tally *t = calloc(1, sizeof *t);
    if (!t) return fail(MERLIN_NO_MEMORY, "no memory to read %s", path);
    scale(values);
    status s = from_tally(path, values, lossy, t, mask);
    free(t);
    if (s != OK) img_free(mask);
    return s;
}
