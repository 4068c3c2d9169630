/* SPDX-License-Identifier: MIT */
#include "lab/eval/metrics/metrics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"

/* CHUNK: windows of a row that are taken together, so that the loops over them are vectors. */
enum { REACH = 5, WINDOW = 2 * REACH + 1, MOMENTS = 5, CHUNK = 64 };

/* Computes the mean squared difference of scale times a and b. */
static double scaled_mse(const img *a, double scale, const img *b, const img *mask)
{
    size_t pixels = (size_t)a->width * (size_t)a->height, count = 0;
    int channels = a->channels;
    double sum = 0;
    for (size_t i = 0; i < pixels; i++) {
        if (!(mask->data[i] > EVAL_MASK_LEVEL)) continue;
        for (int c = 0; c < channels; c++) {
            size_t k = i * (size_t)channels + (size_t)c;
            double d = scale * (double)a->data[k] - (double)b->data[k];
            sum += d * d;
        }
        count += (size_t)channels;
    }
    return count ? sum / (double)count : 0;
}

double eval_mse(const img *a, const img *b, const img *mask)
{
    return scaled_mse(a, 1, b, mask);
}

double eval_mse_scale_free(const img *a, const img *b, const img *mask)
{
    double both = 0, own = 0;
    for (size_t i = 0, channels = (size_t)a->channels; i < img_value_count(a); i++) {
        if (!(mask->data[i / channels] > EVAL_MASK_LEVEL)) continue;
        both += (double)a->data[i] * (double)b->data[i];
        own += (double)a->data[i] * (double)a->data[i];
    }
    return scaled_mse(a, own > 0 ? both / own : 1, b, mask);
}

/* The angle by atan2 of |p × q| and p·q: acos of the dot product alone loses all digits near zero. */
static double angle_between(const float *p, const float *q)
{
    double x = (double)p[1] * q[2] - (double)p[2] * q[1];
    double y = (double)p[2] * q[0] - (double)p[0] * q[2];
    double z = (double)p[0] * q[1] - (double)p[1] * q[0];
    double dot = (double)p[0] * q[0] + (double)p[1] * q[1] + (double)p[2] * q[2];
    return atan2(sqrt(x * x + y * y + z * z), dot);
}

double eval_angle(const img *a, const img *b, const img *mask)
{
    size_t pixels = (size_t)a->width * (size_t)a->height, count = 0;
    double sum = 0;
    for (size_t i = 0; i < pixels; i++) {
        if (!(mask->data[i] > EVAL_MASK_LEVEL)) continue;
        sum += angle_between(a->data + 3 * i, b->data + 3 * i);
        count++;
    }
    return count ? sum / (double)count * (180 / 3.14159265358979323846) : 0;
}

/* One channel of two images on its way to the similarity. */
typedef struct ssim_work {
    const img *a, *b;
    int channel, width; /* width: of the windows' grid */
    double weights[WINDOW];
    double *rows;  /* height × MOMENTS × width: rows filtered horizontally */
    double *means; /* per row of windows */
} ssim_work;

static void gaussian(double weights[WINDOW])
{
    double sum = 0;
    for (int i = 0; i < WINDOW; i++) {
        double x = (i - REACH) / 1.5;
        sum += weights[i] = exp(-0.5 * x * x);
    }
    for (int i = 0; i < WINDOW; i++)
        weights[i] /= sum;
}

/* CHUNK windows of row y: the weighted sums of x, y, x², y², xy along the row. */
static void filter_chunk(const ssim_work *w, const float *a, const float *b, int count, double *out)
{
    int channels = w->a->channels;
    double values[MOMENTS][CHUNK + WINDOW] = {0};
    for (int x = 0; x < count + WINDOW - 1; x++) {
        double p = a[x * channels], q = b[x * channels];
        values[0][x] = p;
        values[1][x] = q;
        values[2][x] = p * p;
        values[3][x] = q * q;
        values[4][x] = p * q;
    }
    for (int i = 0; i < MOMENTS; i++) {
        double sums[CHUNK] = {0};
        for (int k = 0; k < WINDOW; k++)
            for (int x = 0; x < CHUNK; x++)
                sums[x] += w->weights[k] * values[i][x + k];
        memcpy(out + i * w->width, sums, (size_t)count * sizeof *sums);
    }
}

static void filter_row(void *context, size_t y)
{
    const ssim_work *w = context;
    double *out = w->rows + y * MOMENTS * (size_t)w->width;
    for (int x = 0; x < w->width; x += CHUNK) {
        int count = w->width - x < CHUNK ? w->width - x : CHUNK;
        filter_chunk(w, img_at(w->a, x, (int)y) + w->channel, img_at(w->b, x, (int)y) + w->channel, count, out + x);
    }
}

static double similarity(double p, double q, double pp, double qq, double pq)
{
    const double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
    double vp = pp - p * p, vq = qq - q * q, cov = pq - p * q;
    return (2 * p * q + c1) * (2 * cov + c2) / ((p * p + q * q + c1) * (vp + vq + c2));
}

/* The windows from row y on. */
static void compare_row(void *context, size_t y)
{
    const ssim_work *w = context;
    size_t width = (size_t)w->width;
    double sum = 0;
    for (size_t first = 0; first < width; first += CHUNK) {
        size_t count = width - first < CHUNK ? width - first : CHUNK;
        double m[MOMENTS][CHUNK] = {0};
        for (size_t k = 0; k < WINDOW; k++) {
            for (size_t i = 0; i < MOMENTS; i++) {
                const double *row = w->rows + ((y + k) * MOMENTS + i) * width + first;
                for (size_t x = 0; x < count; x++)
                    m[i][x] += w->weights[k] * row[x];
            }
        }
        for (size_t x = 0; x < count; x++)
            sum += similarity(m[0][x], m[1][x], m[2][x], m[3][x], m[4][x]);
    }
    w->means[y] = sum / w->width;
}

static int by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double eval_median(double *values, size_t count)
{
    if (count == 0) return (double)NAN;
    qsort(values, count, sizeof *values, by_value);
    return values[count / 2];
}

status eval_ssim(const img *a, const img *b, double *out)
{
    if (a->width != b->width || a->height != b->height || a->channels != b->channels)
        return fail(MERLIN_WRONG_USE, "structural similarity needs images of one size, not %dx%dx%d and %dx%dx%d",
                    a->width, a->height, a->channels, b->width, b->height, b->channels);
    if (a->width < WINDOW || a->height < WINDOW)
        return fail(MERLIN_WRONG_USE, "structural similarity needs sides of %d pixels or more, not %dx%d", WINDOW,
                    a->width, a->height);
    ssim_work w = {.a = a, .b = b, .width = a->width - WINDOW + 1};
    size_t height = (size_t)a->height, windows = height - WINDOW + 1;
    w.rows = malloc(height * MOMENTS * (size_t)w.width * sizeof *w.rows);
    w.means = malloc(windows * sizeof *w.means);
    if (!w.rows || !w.means) {
        free(w.rows);
        free(w.means);
        return fail(MERLIN_NO_MEMORY, "no memory to compare images of %dx%d", a->width, a->height);
    }
    gaussian(w.weights);
    double sum = 0;
    for (w.channel = 0; w.channel < a->channels; w.channel++) {
        parallel_for(height, filter_row, &w);
        parallel_for(windows, compare_row, &w);
        for (size_t y = 0; y < windows; y++)
            sum += w.means[y];
    }
    free(w.rows);
    free(w.means);
    *out = sum / ((double)windows * a->channels);
    return OK;
}
