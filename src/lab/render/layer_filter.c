/* SPDX-License-Identifier: MIT */
#include "lab/render/layer_filter.h"

#include <stdlib.h>

#include "base/lanes.h"
#include "optics/camera.h"

/* Reflectance of a perfectly black surface by its specular lobe, which keeps the division by albedo bounded. */
static const float lobe_reflectance = 0.05f;

/* Planes of the filter's inputs, with a border of zeros as wide as its radius, so that sixteen pixels of a row are
 * filtered at once without tests for the picture's edges. */
enum { NORMAL_X, NORMAL_Y, NORMAL_Z, DEPTH, MASK, RED, GREEN, BLUE, PLANES };

typedef struct guides {
    float *plane[PLANES]; /* the last three: light, divided by albedo and coverage */
    size_t stride;
    float depth_scale;
    int radius;
} guides;

static status guides_new(const sample *s, const img *layer, int radius, guides *g)
{
    size_t width = (size_t)layer->width, border = (size_t)radius;
    g->radius = radius;
    g->stride = (width + LANES - 1) / LANES * LANES + 2 * border;
    size_t size = g->stride * ((size_t)layer->height + 2 * border);
    camera eye = {.width = layer->width, .height = layer->height, .fov = s->fov, .slant = s->slant};
    /* a slope of two pixels' depth a pixel still has weight one half */
    g->depth_scale = 0.5f / camera_pixel_size(&eye);
    float *all = calloc(PLANES * size, sizeof *all);
    if (!all) return fail(MERLIN_NO_MEMORY, "out of memory for smoothing a picture of %d pixels' width", layer->width);
    for (size_t k = 0; k < PLANES; k++)
        g->plane[k] = all + k * size;
    return OK;
}

/* Returns the index of a pixel in the planes. */
static size_t place_of(const guides *g, int x, int y)
{
    return (size_t)(y + g->radius) * g->stride + (size_t)(x + g->radius);
}

static void fill_guides(guides *g, const sample *s, const img *layer)
{
    size_t i = 0;
    for (int y = 0; y < layer->height; y++)
        for (int x = 0; x < layer->width; x++, i++) {
            size_t to = place_of(g, x, y);
            float coverage = s->mask.data[i];
            for (size_t c = 0; c < 3; c++) {
                g->plane[NORMAL_X + c][to] = s->normal.data[3 * i + c];
                if (coverage > 0)
                    g->plane[RED + c][to] =
                        layer->data[3 * i + c] / (coverage * (s->albedo.data[3 * i + c] + lobe_reflectance));
            }
            g->plane[DEPTH][to] = s->depth.data[i];
            g->plane[MASK][to] = coverage;
        }
}

typedef struct sums {
    lanes light;
    float total[LANES];
} sums;

/* Adds the pixels at `to` to the sums of those at `from`, weighted by coverage and by how well they match the same
 * smooth surface. */
static void add_neighbours(const guides *g, size_t from, size_t to, float distance2, sums *out)
{
    const float *nx = g->plane[NORMAL_X], *ny = g->plane[NORMAL_Y], *nz = g->plane[NORMAL_Z];
    const float *depth = g->plane[DEPTH], *mask = g->plane[MASK];
    const float *red = g->plane[RED], *green = g->plane[GREEN], *blue = g->plane[BLUE];
    float reach = (float)((g->radius + 1) * (g->radius + 1)), near = distance2 < reach ? 1 - distance2 / reach : 0;
    float scale = g->depth_scale, spread = 1 + distance2;
#pragma omp simd
    for (size_t k = 0; k < LANES; k++) {
        size_t i = from + k, j = to + k;
        float cosine = nx[i] * nx[j] + ny[i] * ny[j] + nz[i] * nz[j];
        float c2 = cosine > 0 ? cosine * cosine : 0, c4 = c2 * c2;
        float step = (depth[i] - depth[j]) * scale / depth[i], apart = 1 + step * step / spread;
        float weight = mask[j] * c4 * c4 * near / (apart * apart);
        out->light.x[k] += weight * red[j];
        out->light.y[k] += weight * green[j];
        out->light.z[k] += weight * blue[j];
        out->total[k] += weight;
    }
}

/* Filters pixels x .. x + LANES - 1 of a row. */
static void filter_lanes(const guides *g, const sample *s, int x, int y, img *layer)
{
    sums sum = {.total = {0}};
    size_t from = place_of(g, x, y), i = (size_t)y * (size_t)layer->width + (size_t)x;
    for (int v = -g->radius; v <= g->radius; v++)
        for (int u = -g->radius; u <= g->radius; u++)
            add_neighbours(g, from, place_of(g, x + u, y + v), (float)(u * u + v * v), &sum);
    for (int k = 0; k < LANES && x + k < layer->width; k++, i++) {
        float coverage = s->mask.data[i], *out = layer->data + 3 * i;
        if (coverage <= 0) continue;
        out[0] = sum.light.x[k] / sum.total[k] * coverage * (s->albedo.data[3 * i] + lobe_reflectance);
        out[1] = sum.light.y[k] / sum.total[k] * coverage * (s->albedo.data[3 * i + 1] + lobe_reflectance);
        out[2] = sum.light.z[k] / sum.total[k] * coverage * (s->albedo.data[3 * i + 2] + lobe_reflectance);
    }
}

static bool is_empty(const guides *g, int x, int y)
{
    const float *mask = g->plane[MASK] + place_of(g, x, y);
    float sum = 0;
    for (int k = 0; k < LANES; k++)
        sum += mask[k];
    return sum == 0;
}

status filter_layer(const sample *s, img *layer, int radius)
{
    guides g;
    status st = guides_new(s, layer, radius, &g);
    if (st != OK) return st;
    fill_guides(&g, s, layer);
    for (int y = 0; y < layer->height; y++)
        for (int x = 0; x < layer->width; x += LANES)
            if (!is_empty(&g, x, y)) filter_lanes(&g, s, x, y, layer);
    free(g.plane[0]);
    return OK;
}
