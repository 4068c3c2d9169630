/* SPDX-License-Identifier: MIT */
/* Attention among an object's pictures, at each pixel on its own: the numbers of one pixel and head fit the first-level
 * cache, so that scores, softmax and sums are made in one pass. */
#include <math.h>
#include <string.h>

#include "nn/cpu/kernels/chunk.h"
#include "nn/cpu/kernels/group.h"

/* Query, key and value of one pixel and head, a row a picture, or their gradients. Only pictures that are there have a
 * row. */
typedef float rows[NN_LARGEST_GROUP][CPU_MAX_HEAD];

/* Numbers of the tensors; width: channels a head. */
typedef struct layout {
    size_t objects, pictures, pixels, channels, width;
    float scale; /* 1/√width */
    const cpu_tensor *present;
} layout;

/* A pixel of an object, and which of its pictures are there. */
typedef struct spot {
    size_t object, pixel, count;
    size_t picture[NN_LARGEST_GROUP]; /* in the batch */
} spot;

static layout layout_of(const cpu_tensor *pictures, size_t channels, const cpu_heads *heads)
{
    const size_t width = channels / (size_t)heads->count, count = (size_t)heads->pictures;
    return (layout){.objects = (size_t)pictures->n / count,
                    .pictures = count,
                    .pixels = (size_t)pictures->h * (size_t)pictures->w,
                    .channels = channels,
                    .width = width,
                    .scale = 1 / sqrtf((float)width),
                    .present = heads->present};
}

static spot spot_at(const layout *l, size_t i)
{
    spot s = {.object = i / l->pixels, .pixel = i % l->pixels};
    for (size_t k = 0; k < l->pictures; k++) {
        const size_t picture = s.object * l->pictures + k;
        if (!l->present || ((const float *)l->present->data)[picture] > 0) s.picture[s.count++] = picture;
    }
    return s;
}

/* Loads the pictures' rows of one head; first: the head's first channel in the tensor. */
static void load_rows(const cpu_tensor *t, const layout *l, const spot *s, size_t first, rows to)
{
    for (size_t k = 0; k < s->count; k++) {
        const size_t at = (s->picture[k] * l->pixels + s->pixel) * (size_t)t->c + first;
        const float *from = cpu_load(t, at, l->width, to[k]);
        if (from != to[k]) memcpy(to[k], from, l->width * sizeof *from);
    }
}

static void store_rows(cpu_tensor *t, const layout *l, const spot *s, size_t first, rows from, bool accumulate)
{
    for (size_t k = 0; k < s->count; k++)
        cpu_store(t, (s->picture[k] * l->pixels + s->pixel) * (size_t)t->c + first, l->width, from[k], accumulate);
}

static void clear_rows(rows of, size_t count)
{
    memset(of, 0, count * sizeof *of);
}

/* Writes zero for pictures that are not there. */
static void clear_absent(cpu_tensor *t, const layout *l, const spot *s)
{
    static const float none[CPU_CHUNK];
    size_t next = 0;
    for (size_t k = 0; k < l->pictures && s->count < l->pictures; k++) {
        const size_t picture = s->object * l->pictures + k;
        if (next < s->count && s->picture[next] == picture) {
            next++;
            continue;
        }
        for (size_t c = 0; c < (size_t)t->c; c += CPU_CHUNK) {
            const size_t count = (size_t)t->c - c < CPU_CHUNK ? (size_t)t->c - c : CPU_CHUNK;
            cpu_store(t, (picture * l->pixels + s->pixel) * (size_t)t->c + c, count, none, false);
        }
    }
}

static float dot(const float *a, const float *b, size_t count)
{
    float sum = 0;
#pragma omp simd reduction(+ : sum)
    for (size_t i = 0; i < count; i++)
        sum += a[i] * b[i];
    return sum;
}

/* Adds factor·x to y. */
static void add_scaled(float factor, const float *x, float *y, size_t count)
{
#pragma omp simd
    for (size_t i = 0; i < count; i++)
        y[i] += factor * x[i];
}

/* Computes the weights of all pictures for one query: softmax of its scaled products with their keys. */
static void weigh(const layout *l, const float *query, rows key, size_t count, float *weight)
{
    float largest = -INFINITY, sum = 0;
    for (size_t j = 0; j < count; j++) {
        weight[j] = l->scale * dot(query, key[j], l->width);
        largest = weight[j] > largest ? weight[j] : largest;
    }
    for (size_t j = 0; j < count; j++) {
        weight[j] = expf(weight[j] - largest);
        sum += weight[j];
    }
    for (size_t j = 0; j < count; j++)
        weight[j] /= sum;
}

/* Computes the mean of values by their weights. */
static void attend(const layout *l, const float *weight, rows value, size_t count, float *out)
{
    memset(out, 0, l->width * sizeof *out);
    for (size_t j = 0; j < count; j++)
        add_scaled(weight[j], value[j], out, l->width);
}

/* Adds the gradients of one query's result d to those of query, keys and values. */
static void attend_backward(const layout *l, const float *query, rows key, rows value, size_t count, const float *d,
                            float *dquery, rows dkey, rows dvalue)
{
    float weight[NN_LARGEST_GROUP], dweight[NN_LARGEST_GROUP], mean = 0;
    weigh(l, query, key, count, weight);
    for (size_t j = 0; j < count; j++) {
        add_scaled(weight[j], d, dvalue[j], l->width);
        dweight[j] = dot(d, value[j], l->width);
        mean += weight[j] * dweight[j];
    }
    for (size_t j = 0; j < count; j++) {
        const float dscore = l->scale * weight[j] * (dweight[j] - mean);
        add_scaled(dscore, key[j], dquery, l->width);
        add_scaled(dscore, query, dkey[j], l->width);
    }
}

void cpu_group_attention(const cpu_tensor *x, const cpu_heads *heads, cpu_tensor *y)
{
    const layout l = layout_of(x, (size_t)y->c, heads);
#pragma omp parallel for schedule(static) if (cpu_count(x) > CPU_PARALLEL_MIN)
    for (size_t i = 0; i < l.objects * l.pixels; i++) {
        const spot s = spot_at(&l, i);
        clear_absent(y, &l, &s);
        for (size_t h = 0; h < l.channels; h += l.width) {
            rows query, key, value, out;
            float weight[NN_LARGEST_GROUP];
            load_rows(x, &l, &s, h, query);
            load_rows(x, &l, &s, l.channels + h, key);
            load_rows(x, &l, &s, 2 * l.channels + h, value);
            for (size_t k = 0; k < s.count; k++) {
                weigh(&l, query[k], key, s.count, weight);
                attend(&l, weight, value, s.count, out[k]);
            }
            store_rows(y, &l, &s, h, out, false);
        }
    }
}

void cpu_group_attention_backward(const cpu_tensor *x, const cpu_heads *heads, const cpu_tensor *dy, cpu_tensor *dx,
                                  bool accumulate)
{
    const layout l = layout_of(x, (size_t)dy->c, heads);
#pragma omp parallel for schedule(static) if (cpu_count(x) > CPU_PARALLEL_MIN)
    for (size_t i = 0; i < l.objects * l.pixels; i++) {
        const spot s = spot_at(&l, i);
        if (!accumulate) clear_absent(dx, &l, &s);
        for (size_t h = 0; h < l.channels; h += l.width) {
            rows query, key, value, d, dquery, dkey, dvalue;
            clear_rows(dquery, s.count), clear_rows(dkey, s.count), clear_rows(dvalue, s.count);
            load_rows(x, &l, &s, h, query);
            load_rows(x, &l, &s, l.channels + h, key);
            load_rows(x, &l, &s, 2 * l.channels + h, value);
            load_rows(dy, &l, &s, h, d);
            for (size_t k = 0; k < s.count; k++)
                attend_backward(&l, query[k], key, value, s.count, d[k], dquery[k], dkey, dvalue);
            store_rows(dx, &l, &s, h, dquery, accumulate);
            store_rows(dx, &l, &s, l.channels + h, dkey, accumulate);
            store_rows(dx, &l, &s, 2 * l.channels + h, dvalue, accumulate);
        }
    }
}

void cpu_group_pool(const cpu_tensor *x, const cpu_heads *heads, const float *query, cpu_tensor *y)
{
    const layout l = layout_of(x, (size_t)y->c, heads);
#pragma omp parallel for schedule(static) if (cpu_count(x) > CPU_PARALLEL_MIN)
    for (size_t i = 0; i < l.objects * l.pixels; i++) {
        const spot s = spot_at(&l, i);
        for (size_t h = 0; h < l.channels; h += l.width) {
            rows key, value;
            float weight[NN_LARGEST_GROUP], out[CPU_MAX_HEAD];
            load_rows(x, &l, &s, h, key);
            load_rows(x, &l, &s, l.channels + h, value);
            weigh(&l, query + h, key, s.count, weight);
            attend(&l, weight, value, s.count, out);
            cpu_store(y, i * l.channels + h, l.width, out, false);
        }
    }
}

/* Adds a pixel's share to the gradient of the query, and writes those of its keys and values if dx has data. */
static void pool_pixel_backward(const cpu_tensor *x, const layout *l, const spot *s, const float *query,
                                const cpu_tensor *dy, cpu_tensor *dx, bool accumulate, float *dquery)
{
    const size_t at = (s->object * l->pixels + s->pixel) * l->channels;
    for (size_t h = 0; h < l->channels; h += l->width) {
        rows key, value, dkey, dvalue;
        float room[CPU_MAX_HEAD];
        clear_rows(dkey, s->count), clear_rows(dvalue, s->count);
        load_rows(x, l, s, h, key);
        load_rows(x, l, s, l->channels + h, value);
        attend_backward(l, query + h, key, value, s->count, cpu_load(dy, at + h, l->width, room), dquery + h, dkey,
                        dvalue);
        if (!dx->data) continue;
        store_rows(dx, l, s, h, dkey, accumulate);
        store_rows(dx, l, s, l->channels + h, dvalue, accumulate);
    }
}

void cpu_group_pool_backward(const cpu_tensor *x, const cpu_heads *heads, const float *query, const cpu_tensor *dy,
                             cpu_tensor *dx, bool accumulate, float *partial, float *dquery)
{
    const layout l = layout_of(x, (size_t)dy->c, heads);
    const size_t count = l.objects * l.pixels;
#pragma omp parallel for schedule(static) if (cpu_count(x) > CPU_PARALLEL_MIN)
    for (size_t part = 0; part < CPU_PARTS; part++) {
        float *sum = partial + part * l.channels;
        memset(sum, 0, l.channels * sizeof *sum);
        for (size_t i = count * part / CPU_PARTS; i < count * (part + 1) / CPU_PARTS; i++) {
            const spot s = spot_at(&l, i);
            if (dx->data && !accumulate) clear_absent(dx, &l, &s);
            pool_pixel_backward(x, &l, &s, query, dy, dx, accumulate, sum);
        }
    }
    cpu_sum_parts(partial, l.channels, dquery);
}
