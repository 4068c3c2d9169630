/* SPDX-License-Identifier: MIT */
/* Structural dissimilarity as a loss (Z. Wang, A. C. Bovik, H. R. Sheikh, E. P. Simoncelli, Image quality assessment:
 * from error visibility to structural similarity, IEEE TIP 13(4), 2004): a window around every pixel, black outside the
 * mask and the frame, so that windows without any of the object cost nothing.
 *
 * Each plane (one channel of one picture) is computed by one thread, and planes are summed in order: the same bits for
 * any number of threads. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "nn/cpu/kernels/chunk.h"

enum { REACH = 5, WINDOW = 2 * REACH + 1 };
static const float C1 = 0.01f * 0.01f, C2 = 0.03f * 0.03f;

typedef struct operands {
    const cpu_tensor *prediction, *target, *mask;
    float weight[WINDOW];
} operands;

static operands operands_of(const cpu_tensor *prediction, const cpu_tensor *target, const cpu_tensor *mask)
{
    operands o = {prediction, target, mask, {0}};
    double sum = 0;
    for (int i = 0; i < WINDOW; i++)
        sum += exp(-0.5 * (i - REACH) * (i - REACH) / (1.5 * 1.5));
    for (int i = 0; i < WINDOW; i++)
        o.weight[i] = (float)(exp(-0.5 * (i - REACH) * (i - REACH) / (1.5 * 1.5)) / sum);
    return o;
}

/* A thread's work: one channel of one picture, restricted to the rectangle whose windows contain some of the object. */
typedef struct plane {
    size_t top, left, height, width;
    float *x, *y;                  /* prediction and target times the mask */
    float *mx, *my, *xx, *yy, *xy; /* windowed means of them and of their products */
    float *rows, *line;            /* buffers of blur, with a margin of REACH above and below, left and right */
    float *memory;
} plane;

static bool plane_new(const operands *o, plane *p)
{
    size_t height = (size_t)o->prediction->h, width = (size_t)o->prediction->w, size = height * width;
    *p = (plane){0};
    float *at = p->memory = malloc((8 * size + 2 * REACH * (width + 1) + width) * sizeof *at);
    if (!at) return false;
    float **parts[] = {&p->x, &p->y, &p->mx, &p->my, &p->xx, &p->yy, &p->xy};
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++, at += size)
        *parts[i] = at;
    p->rows = at;
    p->line = at + size + 2 * REACH * width;
    return true;
}

static inline void blur_line(const operands *o, const float *from, size_t step, size_t width, float *to)
{
#pragma omp simd
    for (size_t x = 0; x < width; x++) {
        float sum = 0;
        for (size_t k = 0; k < WINDOW; k++)
            sum += o->weight[k] * from[x + k * step];
        to[x] = sum;
    }
}

/* Replaces values by weighted means over the window, zero beyond the rectangle. */
static void blur(const operands *o, plane *p, float *image)
{
    size_t width = p->width, margin = REACH * width;
    memset(p->line, 0, (width + 2 * REACH) * sizeof *p->line);
    memset(p->rows, 0, margin * sizeof *p->rows);
    memset(p->rows + margin + p->height * width, 0, margin * sizeof *p->rows);
    for (size_t y = 0; y < p->height; y++) {
        memcpy(p->line + REACH, image + y * width, width * sizeof *image);
        blur_line(o, p->line, 1, width, p->rows + margin + y * width);
    }
    for (size_t y = 0; y < p->height; y++)
        blur_line(o, p->rows + y * width, width, width, image + y * width);
}

static size_t less(size_t x)
{
    return x > REACH ? x - REACH : 0;
}

/* Finds the mask's bounding rectangle, enlarged by REACH. */
static void find_rectangle(const operands *o, const float *mask, plane *p)
{
    size_t height = (size_t)o->mask->h, width = (size_t)o->mask->w;
    size_t top = height, bottom = 0, left = width, right = 0;
    for (size_t y = 0; y < height; y++) {
        const float *row = mask + y * width;
        size_t first = 0, end = width;
        while (first < width && row[first] == 0)
            first++;
        if (first == width) continue;
        while (row[end - 1] == 0)
            end--;
        top = min_size(top, y);
        bottom = y + 1;
        left = min_size(left, first);
        right = right > end ? right : end;
    }
    p->top = less(min_size(top, bottom));
    p->left = less(min_size(left, right));
    p->height = bottom ? min_size(bottom + REACH, height) - p->top : 0;
    p->width = bottom ? min_size(right + REACH, width) - p->left : 0;
}

/* Returns where the plane's values in a row of a tensor begin; neighbours are t->c apart. */
static size_t place(const cpu_tensor *t, size_t picture, size_t channel, const plane *p, size_t y)
{
    size_t row = picture * (size_t)t->h + p->top + y;
    return (row * (size_t)t->w + p->left) * (size_t)t->c + channel;
}

static void take_plane(const operands *o, size_t index, plane *p)
{
    size_t channels = (size_t)o->prediction->c, picture = index / channels, channel = index % channels;
    find_rectangle(o, (const float *)o->mask->data + picture * (size_t)o->mask->h * (size_t)o->mask->w, p);
    for (size_t y = 0; y < p->height; y++) {
        const float *a = (const float *)o->prediction->data + place(o->prediction, picture, channel, p, y);
        const float *b = (const float *)o->target->data + place(o->target, picture, channel, p, y);
        const float *m = (const float *)o->mask->data + place(o->mask, picture, 0, p, y);
        float *x = p->x + y * p->width, *z = p->y + y * p->width;
#pragma omp simd
        for (size_t i = 0; i < p->width; i++) {
            x[i] = m[i] != 0 ? a[i * channels] * m[i] : 0;
            z[i] = m[i] != 0 ? b[i * channels] * m[i] : 0;
        }
    }
#pragma omp simd
    for (size_t i = 0; i < p->height * p->width; i++) {
        p->mx[i] = p->x[i];
        p->my[i] = p->y[i];
        p->xx[i] = p->x[i] * p->x[i];
        p->yy[i] = p->y[i] * p->y[i];
        p->xy[i] = p->x[i] * p->y[i];
    }
    float *const blurred[] = {p->mx, p->my, p->xx, p->yy, p->xy};
    for (int i = 0; i < 5; i++)
        blur(o, p, blurred[i]);
}

/* The two factors of the similarity and their denominators, at one window. */
typedef struct terms {
    float light, structure, light_sum, structure_sum;
} terms;

static inline terms terms_at(const plane *p, size_t i)
{
    float x = p->mx[i], y = p->my[i];
    return (terms){2 * x * y + C1, 2 * (p->xy[i] - x * y) + C2, x * x + y * y + C1,
                   p->xx[i] - x * x + p->yy[i] - y * y + C2};
}

static double dissimilarity(const plane *p)
{
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (size_t i = 0; i < p->height * p->width; i++) {
        terms t = terms_at(p, i);
        sum += (double)(1 - t.light * t.structure / (t.light_sum * t.structure_sum));
    }
    return sum;
}

/* Replaces mx, xx and xy by the derivatives of the similarities by them, summed over all windows that contain a pixel.
 */
static void differentiate(const operands *o, plane *p)
{
#pragma omp simd
    for (size_t i = 0; i < p->height * p->width; i++) {
        terms t = terms_at(p, i);
        float x = p->mx[i], y = p->my[i], below = 1 / (t.light_sum * t.structure_sum);
        float similarity = t.light * t.structure * below;
        float beside = 1 / t.light_sum - 1 / t.structure_sum;
        p->mx[i] = 2 * y * (t.structure - t.light) * below - 2 * x * similarity * beside;
        p->xx[i] = -similarity / t.structure_sum;
        p->xy[i] = 2 * t.light * below;
    }
    blur(o, p, p->mx);
    blur(o, p, p->xx);
    blur(o, p, p->xy);
}

static double total_mask(const cpu_tensor *mask)
{
    double sum = 0;
    const float *m = mask->data;
    for (size_t i = 0, n = cpu_count(mask); i < n; i++)
        sum += (double)m[i];
    return sum;
}

static status no_memory(const operands *o)
{
    return fail(MERLIN_NO_MEMORY, "no memory to compare pictures of %dx%d", o->prediction->w, o->prediction->h);
}

/* A function called for each plane once its windowed means are known. */
typedef void plane_work(const operands *o, plane *p, size_t index, void *context);

static status over_planes(const operands *o, plane_work *work, void *context)
{
    size_t planes = (size_t)o->prediction->n * (size_t)o->prediction->c;
    bool good = true;
#pragma omp parallel if (cpu_count(o->prediction) > CPU_PARALLEL_MIN) reduction(&& : good)
    {
        plane p;
        good = plane_new(o, &p);
#pragma omp for schedule(static)
        for (size_t i = 0; i < planes; i++)
            if (good) {
                take_plane(o, i, &p);
                work(o, &p, i, context);
            }
        if (good) free(p.memory);
    }
    return good ? OK : no_memory(o);
}

static void compare(const operands *o, plane *p, size_t index, void *context)
{
    (void)o;
    ((double *)context)[index] = dissimilarity(p);
}

status cpu_masked_dssim(const cpu_tensor *prediction, const cpu_tensor *target, const cpu_tensor *mask,
                        double *mask_sum, float *loss)
{
    operands o = operands_of(prediction, target, mask);
    size_t planes = (size_t)prediction->n * (size_t)prediction->c;
    double *part = calloc(planes, sizeof *part), sum = 0;
    if (!part) return no_memory(&o);
    status s = over_planes(&o, compare, part);
    for (size_t i = 0; i < planes; i++)
        sum += part[i];
    free(part);
    *mask_sum = total_mask(mask);
    *loss = *mask_sum > 0 ? (float)(sum / (*mask_sum * prediction->c)) : 0;
    return s;
}

typedef struct gradient_sum {
    cpu_tensor *tensor;
    float factor;
} gradient_sum;

static void add_gradient(const operands *o, plane *p, size_t index, void *context)
{
    const gradient_sum *to = context;
    differentiate(o, p);
    size_t channels = (size_t)o->prediction->c, picture = index / channels, channel = index % channels;
    for (size_t y = 0; y < p->height; y++) {
        float *d = (float *)to->tensor->data + place(to->tensor, picture, channel, p, y);
        const float *m = (const float *)o->mask->data + place(o->mask, picture, 0, p, y);
        for (size_t x = 0, i = y * p->width; x < p->width; x++, i++)
            d[x * channels] += to->factor * m[x] * (p->mx[i] + 2 * p->x[i] * p->xx[i] + p->y[i] * p->xy[i]);
    }
}

status cpu_masked_dssim_backward(const cpu_tensor *prediction, const cpu_tensor *target, const cpu_tensor *mask,
                                 double mask_sum, float scale, cpu_tensor *dprediction, bool accumulate)
{
    operands o = operands_of(prediction, target, mask);
    gradient_sum to = {dprediction, mask_sum > 0 ? (float)(-(double)scale / (mask_sum * prediction->c)) : 0};
    if (!accumulate) cpu_zero(dprediction);
    return over_planes(&o, add_gradient, &to);
}
