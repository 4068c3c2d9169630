/* SPDX-License-Identifier: MIT */
#include "nn/cpu/kernels/gather.h"

#include <string.h>

#include "base/number.h"
#include "nn/cpu/kernels/chunk.h"

/* A point's four pixels in its image, and their weights. */
typedef struct taps {
    size_t pixel[4];
    float weight[4];
} taps;

/* A line of pixels: the two that a point lies between. */
typedef struct between {
    size_t before, behind;
    float share; /* weight of `behind` */
} between;

static between line_at(float place, int reduction, int size)
{
    const float last = (float)(size - 1), at = (place + 0.5f) / (float)reduction - 0.5f;
    const float inside = at > 0 ? (at < last ? at : last) : 0; /* 0 for a NaN, too */
    const size_t before = (size_t)inside;
    return (between){before, min_size(before + 1, (size_t)size - 1), inside - (float)before};
}

static taps taps_of(const cpu_places *places, const cpu_tensor *map, size_t image, size_t point)
{
    const cpu_tensor *at = places->at;
    const size_t shared = (size_t)map->n / (size_t)at->n;
    const float *place = (const float *)at->data + 2 * (image / shared * (size_t)at->w + point);
    const between x = line_at(place[0], places->reduction, map->w), y = line_at(place[1], places->reduction, map->h);
    const size_t above = y.before * (size_t)map->w, below = y.behind * (size_t)map->w;
    return (taps){{above + x.before, above + x.behind, below + x.before, below + x.behind},
                  {(1 - y.share) * (1 - x.share), (1 - y.share) * x.share, y.share * (1 - x.share), y.share * x.share}};
}

void cpu_gather(const cpu_tensor *x, const cpu_places *places, cpu_tensor *y)
{
    const size_t channels = (size_t)x->c, points = (size_t)y->w, size = (size_t)x->h * (size_t)x->w;
#pragma omp parallel for schedule(static) if (cpu_count(y) > CPU_PARALLEL_MIN)
    for (size_t i = 0; i < (size_t)y->n * points; i++) {
        const taps t = taps_of(places, x, i / points, i % points);
        float room[CPU_MAX_CHANNELS], sum[CPU_MAX_CHANNELS];
        memset(sum, 0, channels * sizeof *sum);
        for (int k = 0; k < 4; k++) {
            const float *p = cpu_load(x, (i / points * size + t.pixel[k]) * channels, channels, room);
#pragma omp simd
            for (size_t c = 0; c < channels; c++)
                sum[c] += t.weight[k] * p[c];
        }
        cpu_store(y, i * channels, channels, sum, false);
    }
}

static void scatter_point(const taps *t, const float *d, size_t channels, float *sums)
{
    for (int k = 0; k < 4; k++) {
        float *to = sums + t->pixel[k] * channels;
#pragma omp simd
        for (size_t c = 0; c < channels; c++)
            to[c] += t->weight[k] * d[c];
    }
}

/* Images are summed one by one, each in the order of its points, so that sums do not depend on the threads. */
void cpu_gather_backward(const cpu_places *places, const cpu_tensor *dy, cpu_tensor *dx, bool accumulate, float *sums)
{
    const size_t channels = (size_t)dx->c, points = (size_t)dy->w, size = (size_t)dx->h * (size_t)dx->w * channels;
#pragma omp parallel for schedule(static) if (cpu_count(dx) > CPU_PARALLEL_MIN)
    for (size_t image = 0; image < (size_t)dx->n; image++) {
        float *own = sums + image * size, room[CPU_MAX_CHANNELS];
        memset(own, 0, size * sizeof *own);
        for (size_t point = 0; point < points; point++) {
            const taps t = taps_of(places, dx, image, point);
            scatter_point(&t, cpu_load(dy, (image * points + point) * channels, channels, room), channels, own);
        }
        cpu_store(dx, image * size, size, own, accumulate);
    }
}
