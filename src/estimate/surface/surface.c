/* SPDX-License-Identifier: MIT */
#include "estimate/surface/surface.h"

#include <stdbool.h>
#include <string.h>

#include "base/inline.h"
#include "base/number.h"
#include "base/parallel.h"
#include "estimate/surface/exposure.h"
#include "estimate/surface/fill.h"
#include "image/resize.h"
#include "model/model.h"
#include "optics/camera.h"

static const float LEAST_ROUGHNESS = 0.03f, LEAST_DEPTH = 0.05f, LARGEST_DEPTH = 20.0f;
/* Least z of normals: those at the silhouette are grazing, and do not face away. */
static const float LEAST_NORMAL_Z = 0.02f;

status surface_new(int width, int height, surface *out)
{
    *out = (surface){0};
    status s = img_new(&out->albedo, width, height, 3);
    if (s == OK) s = img_new(&out->normal, width, height, 3);
    if (s == OK) s = img_new(&out->roughness, width, height, 1);
    if (s == OK) s = img_new(&out->depth, width, height, 1);
    if (s == OK) s = img_new(&out->mask, width, height, 1);
    if (s != OK) surface_free(out);
    return s;
}

void surface_free(surface *s)
{
    img_free(&s->albedo);
    img_free(&s->normal);
    img_free(&s->roughness);
    img_free(&s->depth);
    img_free(&s->mask);
}

static void tidy_normal(float n[3])
{
    const float length = vec3_length(vec3_of(n));
    const float scale = length > 1.001f && isfinite(length) ? 1 / length : 1; /* before ends are cut */
    vec3 v = vec3_make(clamp(scale * n[0], -1, 1), clamp(scale * n[1], -1, 1),
                       n[2] > LEAST_NORMAL_Z ? clamp(scale * n[2], 0, 1) : LEAST_NORMAL_Z);
    vec3_put(vec3_normalize(v), n);
}

/* Sets values to zero, without writing to those that are zero already (image.h). */
static void clear(float *values, int count)
{
    for (int i = 0; i < count; i++)
        if (values[i] != 0) values[i] = 0;
}

static void tidy_pixels(void *context, size_t begin, size_t end)
{
    surface *s = context;
    for (size_t i = begin; i < end; i++) {
        float *albedo = s->albedo.data + 3 * i, *normal = s->normal.data + 3 * i;
        if (!(s->mask.data[i] > 0)) {
            clear(albedo, 3);
            clear(normal, 3);
            clear(&s->roughness.data[i], 1);
            clear(&s->depth.data[i], 1);
            clear(&s->mask.data[i], 1);
            continue;
        }
        s->mask.data[i] = clamp(s->mask.data[i], 0, 1);
        for (int c = 0; c < 3; c++)
            albedo[c] = clamp(albedo[c], 0, 1);
        tidy_normal(normal);
        s->roughness.data[i] = clamp(s->roughness.data[i], LEAST_ROUGHNESS, 1);
        s->depth.data[i] = clamp(s->depth.data[i], LEAST_DEPTH, LARGEST_DEPTH);
    }
}

void surface_tidy(surface *s)
{
    parallel_blocks((size_t)s->mask.width * (size_t)s->mask.height, tidy_pixels, s);
}

/* A normal map, and the mask that it must agree with. */
typedef struct normal_map {
    const img *mask;
    img *normal;
} normal_map;

static void tidy_normals(void *context, size_t begin, size_t end)
{
    const normal_map *m = context;
    for (size_t i = begin; i < end; i++)
        if (m->mask->data[i] > 0)
            tidy_normal(m->normal->data + 3 * i);
        else
            clear(m->normal->data + 3 * i, 3);
}

void surface_tidy_normals(const img *mask, img *normal)
{
    parallel_blocks((size_t)mask->width * (size_t)mask->height, tidy_normals, &(normal_map){mask, normal});
}

void surface_tidy_spread(const img *mask, img *spread)
{
    for (size_t i = 0; i < img_value_count(spread); i++)
        spread->data[i] = mask->data[i] > 0 ? clamp(spread->data[i], 0, 90) : 0;
}

void harden_mask(img *image, img *mask)
{
    size_t count = (size_t)mask->width * (size_t)mask->height;
    for (size_t i = 0; i < count; i++) {
        mask->data[i] = mask->data[i] >= 0.5f;
        for (size_t c = 3 * i; image && c < 3 * i + 3; c++)
            image->data[c] = mask->data[i] > 0 && image->data[c] > 0 ? image->data[c] : 0;
    }
}

/* Averages the covered values, and fills what the mask does not cover from its neighbours. */
static status shrink(const img *from, const img *mask, int width, int height, img *out)
{
    img cover = {0};
    status s = img_resize(mask, width, height, &cover);
    if (s == OK) s = img_resize_masked(from, mask, width, height, out);
    size_t count = s == OK ? (size_t)width * (size_t)height : 0, channels = (size_t)from->channels;
    for (size_t i = 0; i < count; i++) {
        bool covered = cover.data[i] > 1e-3f;
        for (size_t c = channels * i; covered && c < channels * (i + 1); c++)
            out->data[c] /= cover.data[i];
        cover.data[i] = covered;
    }
    if (s == OK) s = fill_outside(out, &cover);
    img_free(&cover);
    return s;
}

status surface_resize_image(const img *from, const img *mask, const img *cover, img *out)
{
    int width = cover->width, height = cover->height;
    if (width < from->width && height < from->height) return shrink(from, mask, width, height, out);
    img filled = {0};
    status s = img_copy(&filled, from);
    if (s == OK) s = fill_outside(&filled, mask);
    if (s == OK && from->width == width && from->height == height) {
        *out = filled;
        return OK;
    }
    if (s == OK) s = img_resize_covered(&filled, cover, out);
    img_free(&filled);
    return s;
}

status surface_resize_indirect(const img *from, const img *mask, const img *cover, img *out)
{
    img filled = {0}, half = {0};
    status s = img_copy(&filled, from);
    if (s == OK) s = fill_outside(&filled, mask);
    if (s == OK) s = img_resize(&filled, from->width / 2, from->height / 2, &half);
    if (s == OK) s = img_resize_covered(&half, cover, out);
    img_free(&filled);
    img_free(&half);
    return s;
}

status surface_resize(const surface *from, const img *mask, surface *out)
{
    *out = (surface){.lens = from->lens};
    status s = img_resize_covered(mask, mask, &out->mask);
    if (s == OK) s = surface_resize_image(&from->albedo, &from->mask, mask, &out->albedo);
    if (s == OK) s = surface_resize_image(&from->normal, &from->mask, mask, &out->normal);
    if (s == OK) s = surface_resize_image(&from->roughness, &from->mask, mask, &out->roughness);
    if (s == OK) s = surface_resize_image(&from->depth, &from->mask, mask, &out->depth);
    if (s != OK)
        surface_free(out);
    else
        surface_tidy(out);
    return s;
}

/* Images needed to resize a map to the guide's size. */
typedef struct refinement {
    const img *low_mask, *guide, *mask;
} refinement;

static status refine(const refinement *r, const img *from, float epsilon, img *out)
{
    enum { RADIUS = 2 };
    img filled = {0};
    status s = img_copy(&filled, from);
    if (s == OK) s = fill_outside(&filled, r->low_mask);
    if (s == OK) s = img_guided_upsample(&filled, r->low_mask, r->guide, r->mask, RADIUS, epsilon, out);
    img_free(&filled);
    return s;
}

typedef struct encoding {
    float *value, scale;
} encoding;

static void encode_values(void *context, size_t begin, size_t end)
{
    const encoding *e = context;
    for (size_t i = begin; i < end; i++)
        if (e->value[i] != 0) e->value[i] = sqrtf(clamp(e->scale * e->value[i], 0, MODEL_BRIGHTEST / EXPOSURE_WHITE));
}

void surface_encode_guide(img *photo, float gain)
{
    encoding e = {photo->data, fminf(gain / EXPOSURE_WHITE, 1)};
    parallel_blocks(img_value_count(photo), encode_values, &e);
}

status surface_refine(const surface *from, const img *guide, const img *mask, surface *out)
{
    const float albedo_epsilon = 1e-4f, roughness_epsilon = 1e-2f;
    if (guide->width < from->mask.width) return surface_resize(from, mask, out);
    *out = (surface){.lens = from->lens};
    refinement r = {&from->mask, guide, mask};
    status s = img_resize_covered(mask, mask, &out->mask);
    if (s == OK) s = refine(&r, &from->albedo, albedo_epsilon, &out->albedo);
    if (s == OK) s = surface_resize_image(&from->normal, &from->mask, mask, &out->normal);
    if (s == OK) s = refine(&r, &from->roughness, roughness_epsilon, &out->roughness);
    if (s == OK) s = surface_resize_image(&from->depth, &from->mask, mask, &out->depth);
    if (s != OK)
        surface_free(out);
    else
        surface_tidy(out);
    return s;
}

typedef struct shading {
    const float *albedo, *normal, *roughness, *depth, *mask;
    vec3 light;
    camera_plane plane;
    float first, step,
        up; /* position of the row's first pixel in the image plane, the step to the next pixel, and the row's height */
    float
        afar; /* 1: the light is in this direction from every pixel's point; 0: at this place relative to the camera */
} shading;

/* Adds one pixel's radiance. GCC vectorizes a loop only if no variable declared in it has its address taken, so that
 * its body is a function. */
ALWAYS_INLINE void shade_pixel(const shading *s, size_t i, int x, bool matte, float *out)
{
    const vec3 ray = camera_on_plane(&s->plane, s->first + (float)x * s->step, s->up);
    shade_input in = {
        .albedo = vec3_of(s->albedo + 3 * i),
        .roughness = s->roughness[i],
        .normal = vec3_of(s->normal + 3 * i),
        .depth = s->depth[i],
        .ray = ray,
        .light = vec3_fma(s->light, s->afar * s->depth[i], ray),
        .power = LIGHT_POWER,
    };
    vec3 radiance = vec3_scale(matte ? shade_point_matte(&in) : shade_point(&in), s->mask[i]);
    out[3 * i] += radiance.x;
    out[3 * i + 1] += radiance.y;
    out[3 * i + 2] += radiance.z;
}

typedef struct lighting {
    const surface *s;
    vec3 light;
    bool distant;
    img *out;
} lighting;

static void shade_rows(void *context, size_t begin, size_t end)
{
    const lighting *job = context;
    const surface *s = job->s;
    const camera view = surface_camera(s);
    const float pixel = camera_pixel_size(&view);
    shading row = {s->albedo.data,
                   s->normal.data,
                   s->roughness.data,
                   s->depth.data,
                   s->mask.data,
                   job->light,
                   camera_plane_of(view.slant),
                   .first = (0.5f - (float)view.width / 2) * pixel,
                   .step = pixel,
                   .afar = job->distant ? 1 : 0};
    float *out = job->out->data;
    for (size_t y = begin; y < end; y++) {
        const img_span span = img_row_span(&s->mask, (int)y);
        const size_t at = y * (size_t)s->mask.width;
        row.up = ((float)view.height / 2 - (float)y - 0.5f) * pixel;
        const shading of = row;
        if (s->matte) {
#pragma omp simd
            for (int x = span.first; x < span.end; x++)
                shade_pixel(&of, at + (size_t)x, x, true, out);
            continue;
        }
#pragma omp simd
        for (int x = span.first; x < span.end; x++)
            shade_pixel(&of, at + (size_t)x, x, false, out);
    }
}

static void add_light(lighting *job)
{
    parallel_blocks((size_t)job->s->mask.height, shade_rows, job);
}

void surface_add_light(const surface *s, vec3 light, img *out)
{
    add_light(&(lighting){.s = s, .light = light, .out = out});
}

status surface_shade(const surface *s, vec3 light, img *out)
{
    lamp near = lamp_at(light);
    return surface_shade_lamp(s, &near, out);
}

status surface_shade_lamp(const surface *s, const lamp *l, img *out)
{
    status result = img_new(out, s->mask.width, s->mask.height, 3);
    if (result == OK) add_light(&(lighting){s, l->at, l->distant, out});
    return result;
}
