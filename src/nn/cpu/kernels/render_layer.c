/* SPDX-License-Identifier: MIT */
/* The rendering layer: material maps under one point light, by the same inline physics as the renderer, and its
 * derivative. It computes whole rows, so that the compiler shades 16 pixels at once; each row is first cut to the span
 * of the mask. */
#include "nn/cpu/kernels/kernels.h"

#include <float.h>

#include "base/number.h"
#include "nn/cpu/kernels/chunk.h"
#include "optics/camera.h"
#include "optics/light.h"

/* One row of the maps, from its first to its last pixel inside the mask. */
typedef struct span {
    const float *albedo, *normal, *roughness, *depth, *mask;
    camera_plane plane;
    float first, step, up; /* position in the image plane: of the first pixel, from one to the next, and of the row */
    float nearer, relief;  /* distance is nearer + relief times the depth */
    vec3 light;
    float power;
    size_t at, count; /* index of the first pixel in the batch; pixels */
} span;

/* Returns the camera of a sample. */
static camera camera_of(const cpu_render_view *view, size_t sample, float *relief)
{
    camera c = {.width = view->mask.w, .height = view->mask.h, .fov = view->fov};
    *relief = 1;
    if (!view->lens.data) return c;
    const float *lens = (const float *)view->lens.data + 3 * sample;
    c.fov = 2 * atanf(lens[0]) / DEGREE;
    c.slant = (camera_slant){lens[1], lens[2]};
    *relief = lens[0] / camera_tangent(view->fov);
    return c;
}

static span span_of_row(const cpu_render_tensors *maps, const cpu_render_view *view, size_t row)
{
    const cpu_tensor *mask = &view->mask;
    size_t width = (size_t)mask->w, height = (size_t)mask->h, begin = row * width, end = begin + width;
    const float *m = mask->data;
    while (begin < end && m[begin] == 0)
        begin++;
    while (begin < end && m[end - 1] == 0)
        end--;
    float relief;
    const camera c = camera_of(view, row / height, &relief);
    float x = (float)(begin % width) + 0.5f, y = (float)(row % height) + 0.5f;
    const float *l = (const float *)view->light.data + 3 * (row / height), pixel = camera_pixel_size(&c);
    return (span){.albedo = (const float *)maps->albedo.data + 3 * begin,
                  .normal = (const float *)maps->normal.data + 3 * begin,
                  .roughness = (const float *)maps->roughness.data + begin,
                  .depth = (const float *)maps->depth.data + begin,
                  .mask = m + begin,
                  .plane = camera_plane_of(c.slant),
                  .first = (x - (float)c.width / 2) * pixel,
                  .step = pixel,
                  .up = ((float)c.height / 2 - y) * pixel,
                  .nearer = 1 - relief,
                  .relief = relief,
                  .light = vec3_of(l),
                  .power = view->light_power,
                  .at = begin,
                  .count = end - begin};
}

/* Maps albedo and roughness from the network's [-1, 1] to [0, 1]. */
static inline float to_unit(float x)
{
    return 0.5f * x + 0.5f;
}

static inline shade_input pixel_of(const span *s, size_t i)
{
    const float *a = s->albedo + 3 * i, *n = s->normal + 3 * i;
    return (shade_input){.albedo = vec3_make(to_unit(a[0]), to_unit(a[1]), to_unit(a[2])),
                         .roughness = to_unit(s->roughness[i]),
                         .normal = vec3_of(n),
                         .depth = s->nearer + s->relief * s->depth[i],
                         .ray = camera_on_plane(&s->plane, s->first + (float)i * s->step, s->up),
                         .light = s->light,
                         .power = s->power};
}

/* Renders a pixel, clipped to [0, 1]; NaN becomes 0. The loop bodies are functions of their own because gcc vectorizes
 * a loop only if nothing declared inside it has its address taken. */
static inline void render_pixel(const span *s, size_t i, float *y)
{
    shade_input in = pixel_of(s, i);
    vec3 radiance = shade_point(&in);
    float m = s->mask[i];
    y[0] = clamp(radiance.x, 0, 1) * m;
    y[1] = clamp(radiance.y, 0, 1) * m;
    y[2] = clamp(radiance.z, 0, 1) * m;
}

static void render_span(const span *row, float *y)
{
    const span s = *row;
#pragma omp simd
    for (size_t i = 0; i < s.count; i++)
        render_pixel(&s, i, y + 3 * i);
}

void cpu_render(const cpu_render_tensors *maps, const cpu_render_view *view, cpu_tensor *y)
{
    size_t width = (size_t)y->w, rows = (size_t)y->n * (size_t)y->h;
#pragma omp parallel for schedule(dynamic, 16) if (cpu_count(&view->mask) > CPU_CHUNK)
    for (size_t row = 0; row < rows; row++) {
        span s = span_of_row(maps, view, row);
        float *out = y->data, *begin = out + 3 * s.at, *end = begin + 3 * s.count;
        render_span(&s, begin);
        memset(out + 3 * row * width, 0, (size_t)((char *)begin - (char *)(out + 3 * row * width)));
        memset(end, 0, (size_t)((char *)(out + 3 * (row + 1) * width) - (char *)end));
    }
}

/* Pixels whose gradients are computed together before they are stored. */
enum { GRADIENT_TILE = 256 };
typedef struct gradient_tile {
    float albedo[3 * GRADIENT_TILE], normal[3 * GRADIENT_TILE], roughness[GRADIENT_TILE], depth[GRADIENT_TILE];
} gradient_tile;

/* Returns the gradient to pass on: none where the output was clipped, and nothing that is not finite. */
static inline float pass(float radiance, float dy)
{
    return radiance > 0 && radiance < 1 ? dy : 0;
}

static inline float finite_or_zero(float g)
{
    float a = g < 0 ? -g : g;
    return a <= FLT_MAX ? g : 0;
}

static inline void differentiate_pixel(const span *s, size_t pixel, const float *dy, gradient_tile *tile, size_t i)
{
    shade_input in = pixel_of(s, pixel);
    vec3 radiance = shade_point(&in);
    float m = s->mask[pixel]; /* at zero nothing is added: neither the clamp nor finite_or_zero lets NaN through */
    vec3 wanted = vec3_make(pass(radiance.x, dy[0] * m), pass(radiance.y, dy[1] * m), pass(radiance.z, dy[2] * m));
    shade_gradient g = shade_point_gradient(&in, wanted);
    tile->albedo[3 * i] = finite_or_zero(0.5f * g.albedo.x);
    tile->albedo[3 * i + 1] = finite_or_zero(0.5f * g.albedo.y);
    tile->albedo[3 * i + 2] = finite_or_zero(0.5f * g.albedo.z);
    tile->normal[3 * i] = finite_or_zero(g.normal.x);
    tile->normal[3 * i + 1] = finite_or_zero(g.normal.y);
    tile->normal[3 * i + 2] = finite_or_zero(g.normal.z);
    tile->roughness[i] = finite_or_zero(0.5f * g.roughness);
    tile->depth[i] = finite_or_zero(s->relief * g.depth);
}

static void differentiate(const span *row, size_t first, size_t count, const float *dy, gradient_tile *tile)
{
    const span s = *row;
#pragma omp simd
    for (size_t i = 0; i < count; i++)
        differentiate_pixel(&s, first + i, dy + 3 * i, tile, i);
}

/* Stores the backward pass's result for one map. */
static void store(cpu_tensor *t, size_t pixel, size_t count, const float *values, bool accumulate)
{
    if (t->data) cpu_store(t, pixel * (size_t)t->c, count * (size_t)t->c, values, accumulate);
}

static void clear_row(cpu_tensor *t, size_t row, bool accumulate)
{
    size_t elements = (size_t)t->w * (size_t)t->c;
    if (t->data && !accumulate) memset((float *)t->data + row * elements, 0, elements * sizeof(float));
}

void cpu_render_backward(const cpu_render_tensors *maps, const cpu_render_view *view, const cpu_tensor *dy,
                         cpu_render_tensors *dmaps, cpu_render_accumulate accumulate)
{
    size_t rows = (size_t)view->mask.n * (size_t)view->mask.h;
#pragma omp parallel for schedule(dynamic, 16) if (cpu_count(&view->mask) > CPU_CHUNK)
    for (size_t row = 0; row < rows; row++) {
        span s = span_of_row(maps, view, row);
        clear_row(&dmaps->albedo, row, accumulate.albedo);
        clear_row(&dmaps->normal, row, accumulate.normal);
        clear_row(&dmaps->roughness, row, accumulate.roughness);
        clear_row(&dmaps->depth, row, accumulate.depth);
        for (size_t first = 0; first < s.count; first += GRADIENT_TILE) {
            gradient_tile tile;
            size_t n = min_size(GRADIENT_TILE, s.count - first), pixel = s.at + first;
            differentiate(&s, first, n, (const float *)dy->data + 3 * pixel, &tile);
            store(&dmaps->albedo, pixel, n, tile.albedo, accumulate.albedo);
            store(&dmaps->normal, pixel, n, tile.normal, accumulate.normal);
            store(&dmaps->roughness, pixel, n, tile.roughness, accumulate.roughness);
            store(&dmaps->depth, pixel, n, tile.depth, accumulate.depth);
        }
    }
}
