/* SPDX-License-Identifier: MIT */
#include "estimate/light/shadow.h"

#include <math.h>
#include <stdbool.h>

#include "base/lanes.h"
#include "base/parallel.h"
#include "estimate/surface/fill.h"
#include "estimate/surface/fuse.h"
#include "optics/camera.h"

/* Range over which the thickness ends. This and the constants below were found by trial (docs/notes/cast_shadows.md).
 */
static const float THICKNESS_BORDER = 0.04f;
/* Distance behind the map from which on a ray is blocked, and the range of the transition, in pixels and as a share of
 * the distance. */
static const float MARGIN = 1, BORDER = 1, BORDER_BY_WAY = 0.03f;
/* Largest slope of a surface, in pixels per pixel. */
static const float STEEPEST = 16;

status shadow_occluder_new(const img *depth, const img *normal, const img *mask, camera_lens lens, shadow_occluder *out)
{
    *out = (shadow_occluder){.lens = lens, .nearest = INFINITY};
    status s = img_copy(&out->mask, mask);
    if (s == OK) s = img_copy(&out->depth, depth);
    if (s == OK) s = fuse_depth(normal, mask, lens, &out->depth);
    if (s == OK) s = fill_outside(&out->depth, mask);
    if (s != OK) {
        shadow_occluder_free(out);
        return s;
    }
    size_t count = (size_t)mask->width * (size_t)mask->height;
    for (size_t i = 0; i < count; i++) {
        if (mask->data[i] < 0.5f) continue;
        out->nearest = fminf(out->nearest, out->depth.data[i]);
        out->farthest = fmaxf(out->farthest, out->depth.data[i]);
    }
    return OK;
}

void shadow_occluder_free(shadow_occluder *occluder)
{
    img_free(&occluder->depth);
    img_free(&occluder->mask);
}

/* ---- interpolation ---- */

/* The four pixels around a place, and their weights. Pixel centres have integer coordinates here; outside the frame the
 * edge is repeated. */
typedef struct corners {
    size_t at[4];
    float weight[4];
} corners;

static corners corners_of(const img *image, float x, float y)
{
    float u = fminf(fmaxf(x, 0), (float)(image->width - 1)), v = fminf(fmaxf(y, 0), (float)(image->height - 1));
    int left = (int)u, top = (int)v;
    int right = left + 1 < image->width ? left + 1 : left, bottom = top + 1 < image->height ? top + 1 : top;
    u -= (float)left;
    v -= (float)top;
    size_t above = (size_t)top * (size_t)image->width, below = (size_t)bottom * (size_t)image->width;
    return (corners){{above + (size_t)left, above + (size_t)right, below + (size_t)left, below + (size_t)right},
                     {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v}};
}

static float value_at(const img *image, const corners *c, int channel)
{
    float sum = 0;
    for (int i = 0; i < 4; i++)
        sum += c->weight[i] * image->data[c->at[i] * (size_t)image->channels + (size_t)channel];
    return sum;
}

/* ---- one ray ---- */

/* A ray in the picture: a straight line in space is one in the picture, along which the inverse of depth changes
 * linearly. */
typedef struct march {
    float x, y, inverse;                /* its start; pixel centres have integer coordinates */
    float step_x, step_y, step_inverse; /* increments per pixel along the longer axis */
    float first, count; /* numbers of steps: to the first pixel centre that counts along that axis, and to the end of
                         * the ray or of the frame */
    bool across;        /* whether the longer axis is x */
    float way;          /* scene units to the end, times the end's inverse depth, per step */
    float pixel;        /* size of a pixel in scene units at the start */
    float slope;        /* increase of the surface's depth per pixel across the ray, to the right or down */
} march;

/* Returns the share of the way from p to the light along which there can be occluders. */
static float part_with_occluders(const shadow_occluder *c, vec3 p, vec3 to_light)
{
    float behind = c->farthest + SHADOW_THICKNESS + THICKNESS_BORDER, part = 1;
    if (p.z + to_light.z > -c->nearest) part = (-c->nearest - p.z) / to_light.z;
    if (p.z + to_light.z < -behind) part = (-behind - p.z) / to_light.z;
    return fminf(part, 1);
}

/* Returns the slope of the surface along one axis; steeper ones are discontinuities between parts. */
static float slope_at(const img *depth, const corners *at, bool down, float pixel)
{
    const float *d = depth->data, *w = at->weight;
    float change;
    if (down)
        change = (w[0] + w[2]) * (d[at->at[2]] - d[at->at[0]]) + (w[1] + w[3]) * (d[at->at[3]] - d[at->at[1]]);
    else
        change = (w[0] + w[1]) * (d[at->at[1]] - d[at->at[0]]) + (w[2] + w[3]) * (d[at->at[3]] - d[at->at[2]]);
    return fabsf(change) < STEEPEST * pixel ? change : 0;
}

/* Returns the number of steps after which one axis leaves a frame of this size. */
static float steps_inside(float from, float step, int size)
{
    if (step == 0) return INFINITY;
    return ((step > 0 ? (float)size - 0.5f : -0.5f) - from) / step;
}

/* Returns the vector to a light; to a distant one, only as far as the visible scene extends. */
static vec3 way_to(const shadow_occluder *c, vec3 p, const lamp *l)
{
    return l->distant ? vec3_scale(l->at, 4 * c->farthest) : vec3_sub(l->at, p);
}

/* Sets up a march; returns false if nothing can block it. */
static bool march_begin(const shadow_occluder *c, float x, float y, const lamp *l, march *m)
{
    corners around = corners_of(&c->depth, x, y);
    float depth = value_at(&c->depth, &around, 0);
    const camera view = camera_through(c->lens, c->depth.width, c->depth.height);
    vec3 p = camera_point(&view, x + 0.5f, y + 0.5f, depth), to_light = way_to(c, p, l);
    float part = part_with_occluders(c, p, to_light);
    if (!(part > 0)) return false;
    vec3 end = vec3_fma(p, part, to_light);
    float end_x, end_y;
    camera_project(&view, end, &end_x, &end_y);
    float dx = end_x - 0.5f - x, dy = end_y - 0.5f - y;
    m->across = fabsf(dx) >= fabsf(dy);
    m->count = m->across ? fabsf(dx) : fabsf(dy);
    if (!(m->count >= 1)) return false;
    m->x = x;
    m->y = y;
    m->inverse = 1 / depth;
    m->step_x = dx / m->count;
    m->step_y = dy / m->count;
    m->step_inverse = (-1 / end.z - m->inverse) / m->count;
    float start = m->across ? x : y, forward = m->across ? dx : dy;
    m->first = forward > 0 ? floorf(start) + 1 - start : start - ceilf(start) + 1;
    if (m->first < 0.5f) m->first += 1; /* the first pixel is the surface at which it starts */
    m->way = part * vec3_length(to_light) * (-1 / end.z) / m->count;
    m->pixel = camera_pixel_size(&view) * depth;
    m->slope = slope_at(&c->depth, &around, m->across, m->pixel);
    m->count = fminf(m->count, fminf(steps_inside(x, m->step_x, view.width), steps_inside(y, m->step_y, view.height)));
    return true;
}

ALWAYS_INLINE float between(float x, float low, float high)
{
    x = x > low ? x : low;
    return x < high ? x : high;
}

/* Returns the certainty that the map's pixel `at` blocks a ray of this depth. */
ALWAYS_INLINE float stops(const shadow_occluder *c, int at, float depth, float margin, float border)
{
    float behind = depth - c->depth.data[at], back = (SHADOW_THICKNESS - behind) / THICKNESS_BORDER + 1;
    float surely = between((behind - margin) / border, 0, 1) * between(back, 0, 1);
    return c->mask.data[at] >= 0.5f ? surely : 0;
}

/* Returns the certainty that the light is hidden after this many steps; outside the frame the edge is repeated. */
ALWAYS_INLINE float met(const shadow_occluder *c, const march *m, float step, bool across)
{
    const int width = c->depth.width, height = c->depth.height;
    float x = between(m->x + step * m->step_x, 0, (float)(width - 1));
    float y = between(m->y + step * m->step_y, 0, (float)(height - 1));
    float depth = 1 / (m->inverse + step * m->step_inverse), way = step * m->way * depth;
    float margin = MARGIN * m->pixel, border = BORDER * m->pixel + BORDER_BY_WAY * way;
    int column = across ? (int)(x + 0.5f) : (int)x, row = across ? (int)y : (int)(y + 0.5f);
    float beside = across ? y - (float)row : x - (float)column;
    int at = row * width + column, last = across ? height - 1 : width - 1;
    int next = at + ((across ? row : column) < last ? across ? width : 1 : 0);
    /* the map's pixels lie beside the ray, where the surface at its start has another depth */
    float a = stops(c, at, depth - beside * m->slope, margin, border);
    float b = stops(c, next, depth + (1 - beside) * m->slope, margin, border);
    return a + beside * (b - a);
}

ALWAYS_INLINE void meet(const shadow_occluder *c, const march *m, float first, bool across, float hidden[LANES])
{
#pragma omp simd
    for (int i = 0; i < LANES; i++)
        hidden[i] = met(c, m, first + (float)i, across);
}

/* Returns the certainty that the light is hidden: the largest along the way. */
static float hidden(const shadow_occluder *c, const march *m)
{
    float most = 0, there[LANES];
    for (float first = m->first; first < m->count && most < 1; first += LANES) {
        if (m->across)
            meet(c, m, first, true, there);
        else
            meet(c, m, first, false, there);
        for (int i = 0; i < LANES && first + (float)i < m->count; i++)
            most = there[i] > most ? there[i] : most;
    }
    return most;
}

/* ---- all of them ---- */

typedef struct cast {
    const shadow_occluder *occluder;
    const lamp *light;
    img *seen;
} cast;

/* Tells whether a point is on or next to the surface: larger pictures have pixels there and interpolate to them. */
static bool near_surface(const img *mask, float x, float y)
{
    int left = (int)floorf(x) - 1, top = (int)floorf(y) - 1;
    for (int row = top > 0 ? top : 0; row < top + 4 && row < mask->height; row++)
        for (int column = left > 0 ? left : 0; column < left + 4 && column < mask->width; column++)
            if (*img_at(mask, column, row) >= 0.5f) return true;
    return false;
}

static void cast_row(void *context, size_t row)
{
    const cast *job = context;
    const shadow_occluder *c = job->occluder;
    float scale_x = (float)c->depth.width / (float)job->seen->width;
    float scale_y = (float)c->depth.height / (float)job->seen->height;
    float y = ((float)row + 0.5f) * scale_y - 0.5f;
    for (int i = 0; i < job->seen->width; i++) {
        float x = ((float)i + 0.5f) * scale_x - 0.5f;
        march m;
        float *seen = img_at(job->seen, i, (int)row);
        *seen = 1;
        if (!near_surface(&c->mask, x, y)) continue;
        if (march_begin(c, x, y, job->light, &m)) *seen = 1 - hidden(c, &m);
    }
}

status shadow_cast(const shadow_occluder *occluder, vec3 light, int width, int height, img *seen)
{
    lamp near = lamp_at(light);
    return shadow_cast_lamp(occluder, &near, width, height, seen);
}

status shadow_cast_lamp(const shadow_occluder *occluder, const lamp *light, int width, int height, img *seen)
{
    status s = img_new(seen, width, height, 1);
    if (s != OK) return s;
    cast job = {occluder, light, seen};
    parallel_for((size_t)height, cast_row, &job);
    return OK;
}

typedef struct darkening {
    const img *seen;
    img *image;
} darkening;

static void darken_rows(void *context, size_t begin, size_t end)
{
    const darkening *d = context;
    float scale_x = (float)d->seen->width / (float)d->image->width;
    float scale_y = (float)d->seen->height / (float)d->image->height;
    for (size_t row = begin; row < end; row++) {
        for (int x = 0; x < d->image->width; x++) {
            corners around =
                corners_of(d->seen, ((float)x + 0.5f) * scale_x - 0.5f, ((float)row + 0.5f) * scale_y - 0.5f);
            float *pixel = img_at(d->image, x, (int)row);
            for (int c = 0; c < d->image->channels; c++)
                if (pixel[c] != 0) pixel[c] *= value_at(d->seen, &around, c % d->seen->channels);
        }
    }
}

void shadow_darken(const img *seen, img *image)
{
    darkening d = {seen, image};
    parallel_blocks((size_t)image->height, darken_rows, &d);
}
