/* SPDX-License-Identifier: MIT */
/* A view of a depth map from the side, so that a person sees what a front view hides. */
#include "surfaces/side_view.h"

#include <math.h>
#include <stdlib.h>

#include "base/vec.h"
#include "optics/pinhole.h"

static const float COSINE = 0.70710678f, GROUND = 0.015f, JUMP = 10, FILL = 0.92f, LEAST_SQUARE = 0.5f;
enum { MOST_CUTS = 12 };

typedef struct view {
    const merlin_surface *surface;
    vec3 low, high; /* bounds of the turned points */
    float scale;
    int stride; /* pixels of the maps from one corner of a square to the next */
    img *out;
    float *nearest; /* z by pixel */
} view;

static bool on_object(const merlin_surface *r, int x, int y)
{
    return *img_at(&r->mask, x, y) > 0.5f && isfinite(*img_at(&r->depth, x, y));
}

static float pixel_size(const merlin_surface *r, float depth)
{
    return pinhole_is_near(&r->camera) ? depth / r->camera.focal : 1;
}

/* The camera-space point of a pixel, turned so that the object's left side comes to the front. */
static vec3 turned(const merlin_surface *r, int x, int y)
{
    float depth = *img_at(&r->depth, x, y), size = pixel_size(r, depth);
    float cx = pinhole_is_near(&r->camera) ? r->camera.x : (float)r->depth.width / 2;
    float cy = pinhole_is_near(&r->camera) ? r->camera.y : (float)r->depth.height / 2;
    vec3 p = vec3_make(((float)x + 0.5f - cx) * size, (cy - (float)y - 0.5f) * size, -depth);
    return vec3_make(COSINE * p.x + COSINE * p.z, p.y, -COSINE * p.x + COSINE * p.z);
}

static bool joined(const view *v, int x, int y)
{
    const merlin_surface *r = v->surface;
    float low = INFINITY, high = -INFINITY;
    for (int k = 0; k < 4; k++) {
        int column = x + k % 2 * v->stride, row = y + k / 2 * v->stride;
        if (!on_object(r, column, row)) return false;
        float depth = *img_at(&r->depth, column, row);
        low = fminf(low, depth);
        high = fmaxf(high, depth);
    }
    return high - low <= JUMP * (float)v->stride * pixel_size(r, low);
}

static void find_bounds(view *v)
{
    const merlin_surface *r = v->surface;
    v->low = vec3_make(INFINITY, INFINITY, INFINITY);
    v->high = vec3_scale(v->low, -1);
    float pixel = 0; /* the largest */
    for (int y = 0; y < r->depth.height; y++)
        for (int x = 0; x < r->depth.width; x++) {
            if (!on_object(r, x, y)) continue;
            vec3 p = turned(r, x, y);
            pixel = fmaxf(pixel, pixel_size(r, *img_at(&r->depth, x, y)));
            v->low = vec3_make(fminf(v->low.x, p.x), fminf(v->low.y, p.y), fminf(v->low.z, p.z));
            v->high = vec3_make(fmaxf(v->high.x, p.x), fmaxf(v->high.y, p.y), fmaxf(v->high.z, p.z));
        }
    float extent = fmaxf(fmaxf(v->high.x - v->low.x, v->high.y - v->low.y), 1e-6f);
    v->scale = FILL * (float)v->out->width / extent;
    float seen = v->scale * pixel; /* size in pixels of the view */
    v->stride = seen < LEAST_SQUARE ? (int)(LEAST_SQUARE / fmaxf(seen, 1e-3f)) : 1;
}

static void splat(view *v, vec3 p, float shade)
{
    int side = v->out->width;
    int x = (int)((p.x - (v->low.x + v->high.x) / 2) * v->scale + (float)side / 2);
    int y = (int)((float)side / 2 - (p.y - (v->low.y + v->high.y) / 2) * v->scale);
    if (x < 0 || x >= side || y < 0 || y >= side) return;
    float *nearest = v->nearest + (size_t)y * (size_t)side + (size_t)x;
    if (p.z <= *nearest) return;
    *nearest = p.z;
    *img_at(v->out, x, y) = shade;
}

/* A square with pixels for corners, covered by as many points as its projection has pixels across. */
static void draw_square(view *v, int x, int y)
{
    vec3 p[4];
    for (int k = 0; k < 4; k++)
        p[k] = turned(v->surface, x + k % 2 * v->stride, y + k / 2 * v->stride);
    vec3 across = vec3_sub(p[1], p[0]), down = vec3_sub(p[2], p[0]);
    vec3 n = vec3_normalize(vec3_cross(down, across));
    float shade = 0.03f + 0.8f * fmaxf(n.z, 0);
    float longest = fmaxf(vec3_length(across), vec3_length(down)) * v->scale;
    int cuts = (int)(1.5f * longest) + 1;
    cuts = cuts < MOST_CUTS ? cuts : MOST_CUTS;
    for (int j = 0; j <= cuts; j++)
        for (int i = 0; i <= cuts; i++) {
            real s = (real)i / (real)cuts, t = (real)j / (real)cuts;
            splat(v, vec3_lerp(vec3_lerp(p[0], p[1], s), vec3_lerp(p[2], p[3], s), t), shade);
        }
}

status surface_side_view(const merlin_surface *r, int side, img *out)
{
    status s = img_new(out, side, side, 1);
    if (s != OK) return s;
    view v = {.surface = r, .out = out};
    size_t count = (size_t)side * (size_t)side;
    v.nearest = malloc(count * sizeof *v.nearest);
    if (!v.nearest) {
        img_free(out);
        return fail(MERLIN_NO_MEMORY, "no memory for a side view");
    }
    for (size_t i = 0; i < count; i++) {
        v.nearest[i] = -INFINITY;
        out->data[i] = GROUND;
    }
    find_bounds(&v);
    for (int y = 0; y + v.stride < r->depth.height; y += v.stride)
        for (int x = 0; x + v.stride < r->depth.width; x += v.stride)
            if (joined(&v, x, y)) draw_square(&v, x, y);
    free(v.nearest);
    return OK;
}
