#include "eval/metrics.h"

#include <math.h>
#include <stdlib.h>

#include "base/parallel.h"

enum { REACH = 5, WINDOW = 2 * REACH + 1, MOMENTS = 5 };

double eval_mse(const img *a, const img *b, const img *mask)
{
    size_t pixels = (size_t)a->width * (size_t)a->height, count = 0;
    int channels = a->channels;
    double sum = 0;
    for (size_t i = 0; i < pixels; i++) {
        if (!(mask->data[i] > EVAL_MASK_LEVEL)) continue;
        for (int c = 0; c < channels; c++) {
            double d = (double)a->data[i * (size_t)channels + (size_t)c] - b->data[i * (size_t)channels + (size_t)c];
            sum += d * d;
        }
        count += (size_t)channels;
    }
    return count ? sum / (double)count : 0;
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

/* Row y of x, y, x², y², xy, each filtered along the row. */
static void filter_row(void *context, size_t y)
{
    const ssim_work *w = context;
    int channels = w->a->channels;
    double *out = w->rows + y * MOMENTS * (size_t)w->width;
    for (int i = 0; i < MOMENTS * w->width; i++)
        out[i] = 0;
    const float *a = img_at(w->a, 0, (int)y) + w->channel, *b = img_at(w->b, 0, (int)y) + w->channel;
    for (int k = 0; k < WINDOW; k++) {
        double g = w->weights[k];
        for (int x = 0; x < w->width; x++) {
            double p = a[(x + k) * channels], q = b[(x + k) * channels];
            out[x] += g * p;
            out[w->width + x] += g * q;
            out[2 * w->width + x] += g * p * p;
            out[3 * w->width + x] += g * q * q;
            out[4 * w->width + x] += g * p * q;
        }
    }
}

static double similarity(const double m[MOMENTS])
{
    const double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
    double vp = m[2] - m[0] * m[0], vq = m[3] - m[1] * m[1], cov = m[4] - m[0] * m[1];
    return (2 * m[0] * m[1] + c1) * (2 * cov + c2) / ((m[0] * m[0] + m[1] * m[1] + c1) * (vp + vq + c2));
}

static void compare_row(void *context, size_t y)
{
    const ssim_work *w = context;
    double sum = 0;
    for (int x = 0; x < w->width; x++) {
        double m[MOMENTS] = {0};
        for (int k = 0; k < WINDOW; k++) {
            const double *row = w->rows + (y + (size_t)k) * MOMENTS * (size_t)w->width + x;
            for (int i = 0; i < MOMENTS; i++)
                m[i] += w->weights[k] * row[(size_t)i * (size_t)w->width];
        }
        sum += similarity(m);
    }
    w->means[y] = sum / w->width;
}

status eval_ssim(const img *a, const img *b, double *out)
{
    if (a->width != b->width || a->height != b->height || a->channels != b->channels)
        return fail(ERROR_USAGE, "structural similarity needs images of one size, not %dx%dx%d and %dx%dx%d", a->width,
                    a->height, a->channels, b->width, b->height, b->channels);
    if (a->width < WINDOW || a->height < WINDOW)
        return fail(ERROR_USAGE, "structural similarity needs sides of %d pixels or more, not %dx%d", WINDOW, a->width,
                    a->height);
    ssim_work w = {.a = a, .b = b, .width = a->width - WINDOW + 1};
    size_t height = (size_t)a->height, windows = height - WINDOW + 1;
    w.rows = malloc(height * MOMENTS * (size_t)w.width * sizeof *w.rows);
    w.means = malloc(windows * sizeof *w.means);
    if (!w.rows || !w.means) {
        free(w.rows);
        free(w.means);
        return fail(ERROR_MEMORY, "no memory to compare images of %dx%d", a->width, a->height);
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
