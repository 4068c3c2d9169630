/* SPDX-License-Identifier: MIT */
/* Guided filter (He, Sun & Tang 2013): in every window the map is a linear function of the guide, q = a·I + b. Fast
 * form (He & Sun 2015): a and b are computed at the map's size and enlarged. All means are weighted by the mask, so
 * that a window across the border sees only what is inside. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "image/resize.h"

enum { GUIDE = 3, PAIRS = 6 };

/* Planes of the statistics image: weight, guide, guide × guide (upper triangle), then map, guide × map. */
enum { AT_WEIGHT = 0, AT_GUIDE = 1, AT_PAIRS = AT_GUIDE + GUIDE, AT_MAP = AT_PAIRS + PAIRS };

/* Coefficients of one map channel: a (3 values) and b; they follow one plane of weight. */
enum { PER_CHANNEL = GUIDE + 1 };

static float guide_value(const img *guide, size_t pixel, int c)
{
    return guide->data[pixel * (size_t)guide->channels + (size_t)(guide->channels == GUIDE ? c : 0)];
}

/* Shrinks the guide to the map's size, each pixel the mean of what lies inside the mask. */
static status shrink_guide(const img *guide, const img *mask, int width, int height, img *out)
{
    img cover = {0};
    if (!mask) return img_resize(guide, width, height, out);
    *out = (img){0};
    status s = img_resize(mask, width, height, &cover);
    if (s == OK) s = img_resize_masked(guide, mask, width, height, out);
    size_t count = s == OK ? (size_t)width * (size_t)height * (size_t)guide->channels : 0;
    for (size_t i = 0; i < count; i++) {
        float c = cover.data[i / (size_t)guide->channels];
        out->data[i] = c > 1e-6f ? out->data[i] / c : 0;
    }
    img_free(&cover);
    return s;
}

static void fill_statistics(const img *low, const img *low_mask, const img *guide, img *stats)
{
    size_t pixels = (size_t)low->width * (size_t)low->height, n = (size_t)low->channels;
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < pixels; i++) {
        float w = low_mask ? low_mask->data[i] : 1, *s = stats->data + i * (size_t)stats->channels;
        if (!(w > 0)) continue;
        float *pair = s + AT_PAIRS, *map = s + AT_MAP;
        s[AT_WEIGHT] = w;
        for (int a = 0; a < GUIDE; a++) {
            s[AT_GUIDE + a] = w * guide_value(guide, i, a);
            for (int b = a; b < GUIDE; b++)
                *pair++ = w * guide_value(guide, i, a) * guide_value(guide, i, b);
        }
        for (size_t c = 0; c < n; c++) {
            float v = w * low->data[i * n + c];
            *map++ = v;
            for (int a = 0; a < GUIDE; a++)
                *map++ = v * guide_value(guide, i, a);
        }
    }
}

/* Inverts the symmetric matrix m (upper triangle: xx xy xz yy yz zz), in the same order. */
static void invert(const double m[PAIRS], double out[PAIRS])
{
    double xx = m[3] * m[5] - m[4] * m[4], xy = m[2] * m[4] - m[1] * m[5], xz = m[1] * m[4] - m[2] * m[3];
    double determinant = m[0] * xx + m[1] * xy + m[2] * xz;
    out[0] = xx / determinant;
    out[1] = xy / determinant;
    out[2] = xz / determinant;
    out[3] = (m[0] * m[5] - m[2] * m[2]) / determinant;
    out[4] = (m[1] * m[2] - m[0] * m[4]) / determinant;
    out[5] = (m[0] * m[3] - m[1] * m[1]) / determinant;
}

/* Computes a and b of one window from its sums (He et al. 2013, eq. 14 and 15), into out's PER_CHANNEL values a
 * channel. */
static void solve_window(const float *sums, int channels, double epsilon, float *out)
{
    double w = sums[AT_WEIGHT], mean[GUIDE], covariance[PAIRS] = {0}, inverse[PAIRS];
    for (int a = 0; a < GUIDE; a++)
        mean[a] = sums[AT_GUIDE + a] / w;
    for (int a = 0, k = 0; a < GUIDE; a++)
        for (int b = a; b < GUIDE; b++, k++)
            covariance[k] = sums[AT_PAIRS + k] / w - mean[a] * mean[b] + (a == b ? epsilon : 0);
    invert(covariance, inverse);
    for (int c = 0; c < channels; c++, out += PER_CHANNEL) {
        const float *map = sums + AT_MAP + c * PER_CHANNEL;
        double value = map[0] / w, x = map[1] / w - value * mean[0], y = map[2] / w - value * mean[1],
               z = map[3] / w - value * mean[2];
        double a0 = inverse[0] * x + inverse[1] * y + inverse[2] * z;
        double a1 = inverse[1] * x + inverse[3] * y + inverse[4] * z;
        double a2 = inverse[2] * x + inverse[4] * y + inverse[5] * z;
        out[0] = (float)a0;
        out[1] = (float)a1;
        out[2] = (float)a2;
        out[3] = (float)(value - a0 * mean[0] - a1 * mean[1] - a2 * mean[2]);
    }
}

/* Computes every window's coefficients, premultiplied by their weight (1 where the window saw anything inside the
 * mask). */
static void solve_windows(const img *sums, int channels, double epsilon, img *coefficients)
{
    size_t pixels = (size_t)sums->width * (size_t)sums->height;
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < pixels; i++) {
        const float *s = sums->data + i * (size_t)sums->channels;
        float *out = coefficients->data + i * (size_t)coefficients->channels;
        if (s[AT_WEIGHT] < 1e-3f) continue;
        out[0] = 1;
        solve_window(s, channels, epsilon, out + 1);
    }
}

/* Interpolates the four nearest windows' coefficients bilinearly into out (weight first). */
static void sample(const img *coefficients, double x, double y, float *out)
{
    int x0 = (int)floor(x), y0 = (int)floor(y), planes = coefficients->channels;
    memset(out, 0, (size_t)planes * sizeof *out);
    for (int k = 0; k < 4; k++) {
        int at_x = x0 + (k & 1), at_y = y0 + (k >> 1);
        double share = (k & 1 ? x - x0 : x0 + 1 - x) * (k >> 1 ? y - y0 : y0 + 1 - y);
        at_x = at_x < 0 ? 0 : at_x >= coefficients->width ? coefficients->width - 1 : at_x;
        at_y = at_y < 0 ? 0 : at_y >= coefficients->height ? coefficients->height - 1 : at_y;
        const float *from = img_at(coefficients, at_x, at_y);
        for (int p = 0; p < planes; p++)
            out[p] += (float)share * from[p];
    }
}

/* Computes the map's mean over its mask, the result where no window is near. */
static void find_mean(const img *low, const img *low_mask, float *mean)
{
    size_t pixels = (size_t)low->width * (size_t)low->height, n = (size_t)low->channels;
    for (size_t c = 0; c < n; c++) {
        double sum = 0, weight = 0;
        for (size_t i = 0; i < pixels; i++) {
            double w = low_mask ? low_mask->data[i] : 1;
            if (!(w > 0)) continue;
            sum += w * low->data[i * n + c];
            weight += w;
        }
        mean[c] = weight > 0 ? (float)(sum / weight) : 0;
    }
}

static void apply_pixel(const img *guide, size_t pixel, const float *k, const float *mean, int channels, float *out)
{
    for (int c = 0; c < channels; c++) {
        const float *a = k + 1 + c * PER_CHANNEL;
        float value = a[3];
        for (int g = 0; g < GUIDE; g++)
            value += a[g] * guide_value(guide, pixel, g);
        out[c] = k[0] > 1e-3f ? value / k[0] : mean[c];
    }
}

static status apply(const img *coefficients, const img *guide, const img *mask, const float *mean, img *out)
{
    double scale_x = (double)coefficients->width / guide->width, scale_y = (double)coefficients->height / guide->height;
    int failed = 0;
#pragma omp parallel
    {
        float *k = malloc((size_t)coefficients->channels * sizeof *k);
        if (!k) {
#pragma omp atomic write
            failed = 1;
        }
#pragma omp for schedule(static)
        for (int y = 0; y < out->height; y++)
            for (int x = 0; k && x < out->width; x++) {
                size_t pixel = (size_t)y * (size_t)out->width + (size_t)x;
                if (mask && !(mask->data[pixel] > 0)) continue;
                sample(coefficients, (x + 0.5) * scale_x - 0.5, (y + 0.5) * scale_y - 0.5, k);
                apply_pixel(guide, pixel, k, mean, out->channels, img_at(out, x, y));
            }
        free(k);
    }
    return failed ? fail(MERLIN_NO_MEMORY, "no memory to filter an image") : OK;
}

static status check_sizes(const img *low, const img *low_mask, const img *guide, const img *mask, int radius,
                          float epsilon)
{
    if (!low->data || !guide->data || (guide->channels != 1 && guide->channels != GUIDE))
        return fail(MERLIN_WRONG_USE, "a guided filter needs a map and a grey or colour guide");
    if (low_mask && (low_mask->width != low->width || low_mask->height != low->height || low_mask->channels != 1))
        return fail(MERLIN_WRONG_USE, "the low mask of a guided filter has another size than the map");
    if (mask && (mask->width != guide->width || mask->height != guide->height || mask->channels != 1))
        return fail(MERLIN_WRONG_USE, "the mask of a guided filter has another size than the guide");
    if (radius < 1 || !(epsilon > 0))
        return fail(MERLIN_WRONG_USE, "a guided filter needs a radius and an epsilon above 0");
    return OK;
}

/* Computes the mean coefficients of all windows at the map's size. */
static status find_coefficients(const img *low, const img *low_mask, const img *guide, int radius, float epsilon,
                                img *coefficients)
{
    img stats = {0};
    int planes = AT_MAP + low->channels * PER_CHANNEL;
    status s = img_new(&stats, low->width, low->height, planes);
    if (s == OK) fill_statistics(low, low_mask, guide, &stats);
    if (s == OK) s = img_box_sums(&stats, radius);
    if (s == OK) s = img_new(coefficients, low->width, low->height, 1 + low->channels * PER_CHANNEL);
    if (s == OK) solve_windows(&stats, low->channels, epsilon, coefficients);
    if (s == OK) s = img_box_sums(coefficients, radius);
    img_free(&stats);
    return s;
}

status img_guided_upsample(const img *low, const img *low_mask, const img *guide, const img *mask, int radius,
                           float epsilon, img *out)
{
    img small = {0}, coefficients = {0};
    *out = (img){0};
    status s = check_sizes(low, low_mask, guide, mask, radius, epsilon);
    if (s != OK) return s;
    float *mean = calloc((size_t)low->channels, sizeof *mean);
    if (!mean) s = fail(MERLIN_NO_MEMORY, "no memory to filter an image");
    if (s == OK) s = shrink_guide(guide, mask, low->width, low->height, &small);
    if (s == OK) s = find_coefficients(low, low_mask, &small, radius, epsilon, &coefficients);
    if (s == OK) s = img_new(out, guide->width, guide->height, low->channels);
    if (s == OK) {
        find_mean(low, low_mask, mean);
        s = apply(&coefficients, guide, mask, mean, out);
    }
    if (s != OK) img_free(out);
    img_free(&small);
    img_free(&coefficients);
    free(mean);
    return s;
}
