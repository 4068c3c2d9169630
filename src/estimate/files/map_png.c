/* SPDX-License-Identifier: MIT */
#include "estimate/files/map_png.h"

#include <math.h>

#include "image/write/write.h"

static void encode_normals(const void *context, size_t first, size_t count, float *values)
{
    const img *mask = context;
    for (size_t i = 0; i < 3 * count; i++)
        values[i] = mask->data[first + i / 3] > 0 ? 0.5f * values[i] + 0.5f : 0;
}

status map_write_normals(const char *path, const img *normal, const img *mask)
{
    return img_write_png_changed(path, normal, IMG_LINEAR16, encode_normals, mask);
}

typedef struct depth_range {
    const img *mask;
    float near, far;
} depth_range;

static depth_range range_of(const img *depth, const img *mask)
{
    depth_range r = {mask, INFINITY, -INFINITY};
    for (size_t i = 0; i < img_value_count(depth); i++) {
        if (mask->data[i] < 0.5f) continue;
        r.near = fminf(r.near, depth->data[i]);
        r.far = fmaxf(r.far, depth->data[i]);
    }
    return r.near <= r.far ? r : (depth_range){mask, 0, 0};
}

static void encode_depths(const void *context, size_t first, size_t count, float *values)
{
    const depth_range *r = context;
    float span = r->far - r->near + 1e-6f;
    for (size_t i = 0; i < count; i++)
        values[i] = r->mask->data[first + i] > 0 ? 1 - 0.95f * (values[i] - r->near) / span : 0;
}

status map_write_depths(const char *path, const img *depth, const img *mask)
{
    depth_range r = range_of(depth, mask);
    return img_write_png_changed(path, depth, IMG_LINEAR16, encode_depths, &r);
}

static void encode_confidence(const void *context, size_t first, size_t count, float *values)
{
    const float unsure = 30;
    const img *mask = context;
    for (size_t i = 0; i < count; i++)
        values[i] = mask->data[first + i] > 0 ? fmaxf(1 - values[i] / unsure, 0) : 0;
}

status map_write_confidence(const char *path, const img *spread, const img *mask)
{
    return img_write_png_changed(path, spread, IMG_LINEAR8, encode_confidence, mask);
}
