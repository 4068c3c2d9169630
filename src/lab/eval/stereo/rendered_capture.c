/* SPDX-License-Identifier: MIT */
#include "lab/eval/stereo/rendered_capture.h"

#include <math.h>
#include <stdlib.h>

#include "base/parallel.h"
#include "lab/eval/metrics/metrics.h"
#include "lab/render/paths.h"
#include "optics/brdf.h"
#include "optics/camera.h"
#include "optics/led.h"

enum { MOST_POINTS = 16 };
/* Least cosine to the line of sight; more grazing surfaces cover too little of a pixel. */
static const real least_facing = (real)0.05;
/* Distance of the lights that makes them as parallel as the sun's for an object of size 1. */
static const float far_away = 500;

/* Data that all rows share. */
typedef struct job {
    const rendered *how;
    const scene_object *object;
    trace_device *device;
    merlin_capture *capture;
    status result;
} job;

/* Data of one thread. */
typedef struct rendering {
    const rendered *how;
    merlin_capture *capture;
    trace_scene scene;
    sequence spread;
    rng random;
    uint32_t path; /* index of the next one */
} rendering;

/* The points of one pixel. */
typedef struct sight {
    int count;
    scene_surface at[MOST_POINTS];
    vec3 view[MOST_POINTS];
} sight;

/* ---- lights ---- */

/* Returns a light of two rings and a few between, as capture domes have. */
static vec3 distant_light(int i, int count)
{
    int inner = count / 3;
    float phi =
        6.2831853f * (i < inner ? (float)i / (float)inner : ((float)(i - inner) + 0.5f) / (float)(count - inner));
    float tilt = i < inner ? 0.35f : 0.75f + 0.25f * (float)(i % 3);
    return vec3_make(sinf(tilt) * cosf(phi), sinf(tilt) * sinf(phi), cosf(tilt));
}

/* Returns an LED of rings around the camera that point at the object, at one to two of its sizes. */
static merlin_light led(int i, int count)
{
    float phi = 6.2831853f * (float)i / (float)count * 2, ring = i % 2 ? 0.3f : 0.65f;
    merlin_light light = {.position = {ring * cosf(phi), ring * sinf(phi), i % 2 ? -0.05f : -0.3f}, .lobe = 1.5f};
    vec3_put(vec3_normalize(vec3_sub(vec3_make(0, 0, -1), vec3_of(light.position))), light.direction);
    return light;
}

/* Returns a position on a spiral over the half of the sphere of radius 1 around (0, 0, -1) that faces the camera. */
static vec3 bulb(int i, int count)
{
    float z = ((float)i + 0.5f) / (float)count, across = sqrtf(1 - z * z), phi = 2.3999632f * (float)i;
    return vec3_make(across * cosf(phi), across * sinf(phi), z - 1);
}

static bool is_near(const rendered *how)
{
    return how->leds || how->bulbs;
}

static merlin_light light_of(const rendered *how, int i)
{
    merlin_light light = {0};
    if (how->leds)
        light = led(i, how->lights);
    else if (how->bulbs)
        vec3_put(bulb(i, how->lights), light.position);
    else
        vec3_put(distant_light(i, how->lights), light.direction);
    for (int k = 0; k < 3; k++)
        light.intensity[k] = 1;
    return light;
}

/* ---- one pixel ---- */

/* Returns the share of the light from l that is reflected toward the view. */
static vec3 reflected(const rendered *how, const scene_surface *at, vec3 view, vec3 l)
{
    bool lambert = how->matte || how->phong > 0;
    vec3 f = lambert ? vec3_scale(at->albedo, 1 / (real)PI) : brdf_eval(at->albedo, at->roughness, at->normal, l, view);
    if (how->phong > 0 && !how->matte) {
        float lobe = how->phong * powf(fmaxf(vec3_dot(at->normal, brdf_half_vector(l, view)), 0), how->exponent);
        f = vec3_add(f, vec3_make(lobe, lobe, lobe));
    }
    return vec3_scale(f, vec3_dot(at->normal, l));
}

static bool is_lit(rendering *r, const scene_surface *at, vec3 l, float distance)
{
    if (!(vec3_dot(at->normal, l) > 0) || !(vec3_dot(at->geometric_normal, l) > 0)) return false;
    return r->how->unshadowed || !trace_occluded(&r->scene, trace_leave(at), l, distance);
}

/* Returns the light as the tracer has it, of power 1; a distant one is as bright from far away. */
static point_light source_of(const rendered *how, const merlin_light *from)
{
    if (!is_near(how))
        return (point_light){.position = vec3_scale(vec3_of(from->direction), far_away), .power = far_away * far_away};
    return (point_light){
        .position = vec3_of(from->position), .power = 1, .axis = vec3_of(from->direction), .lobe = from->lobe};
}

static vec3 by_way_of_surfaces(rendering *r, const scene_surface *at, vec3 view, const point_light *source)
{
    path_points point = {at, &view, 1, r->path++};
    path_source drawn = {&r->spread, &r->random};
    vec3 bounce[1][2];
    point_light_paths(&r->scene, &point, 1, source, &drawn, 1, bounce);
    return vec3_add(bounce[0][0], bounce[0][1]);
}

/* Returns the radiance by one light. */
static vec3 radiance(rendering *r, const scene_surface *at, vec3 view, const merlin_light *from)
{
    bool near = is_near(r->how);
    const point_light source = source_of(r->how, from);
    vec3 to = vec3_sub(source.position, at->position), l = near ? vec3_normalize(to) : vec3_of(from->direction);
    vec3 sum = {0, 0, 0};
    float power = near ? led_share(source.axis, source.lobe, l) / vec3_dot(to, to) : 1;
    if (is_lit(r, at, l, vec3_length(to))) sum = vec3_scale(reflected(r->how, at, view, l), power);
    return r->how->paths > 0 ? vec3_add(sum, by_way_of_surfaces(r, at, view, &source)) : sum;
}

static void camera_ray_of(const rendered *how, float x, float y, vec3 *origin, vec3 *direction)
{
    camera eye = {.width = how->size, .height = how->size, .fov = how->fov};
    float pixel = 1.1f / (float)how->size, middle = 0.5f * (float)how->size;
    *origin = how->fov > 0 ? vec3_make(0, 0, 0) : vec3_make((x - middle) * pixel, (middle - y) * pixel, 0);
    *direction = how->fov > 0 ? camera_ray(&eye, x, y) : vec3_make(0, 0, -1);
}

static void apply_material(const rendered *how, scene_surface *at)
{
    if (how->roughness > 0) at->roughness = how->roughness;
    if (how->paleness > 0) at->albedo = vec3_scale(at->albedo, how->paleness);
    if (how->grey) at->albedo = vec3_make(at->albedo.y, at->albedo.y, at->albedo.y);
}

/* Samples a pixel; returns false if a part of it shows no object. */
static bool look(rendering *r, int i, int j, sight *out)
{
    int strata = r->how->strata > 0 ? r->how->strata : 1;
    out->count = strata * strata;
    for (int s = 0; s < out->count; s++) {
        int column = s % strata, row = s / strata;
        vec3 origin, direction;
        camera_ray_of(r->how, (float)i + ((float)column + 0.5f) / (float)strata,
                      (float)j + ((float)row + 0.5f) / (float)strata, &origin, &direction);
        if (!trace_surface(&r->scene, origin, direction, &out->at[s])) return false;
        out->view[s] = vec3_scale(direction, -1);
        apply_material(r->how, &out->at[s]);
    }
    return true;
}

static bool store_truth(const sight *seen, size_t pixel, const img *truth, merlin_capture *c)
{
    vec3 normal = {0, 0, 0}, albedo = {0, 0, 0};
    float depth = 0;
    for (int s = 0; s < seen->count; s++) {
        normal = vec3_add(normal, seen->at[s].normal);
        albedo = vec3_fma(albedo, 1 / (real)seen->count, seen->at[s].albedo);
        depth -= seen->at[s].position.z / (float)seen->count;
    }
    normal = vec3_normalize(normal);
    if (normal.z < least_facing) return false;
    c->mask.data[pixel] = 1;
    c->depth_true.data[pixel] = depth;
    vec3_put(normal, c->normal_true.data + 3 * pixel);
    if (truth) vec3_put(albedo, truth->data + 3 * pixel);
    return true;
}

static uint16_t code_of(const rendered *how, float value)
{
    float v = fminf(how->exposure * value, 1);
    return how->eight_bit ? (uint16_t)(roundf(v * 255) * 257) : (uint16_t)lroundf(v * 65535);
}

static void render_pixel(rendering *r, int i, int j)
{
    const rendered *how = r->how;
    merlin_capture *c = r->capture;
    size_t pixel = (size_t)j * (size_t)how->size + (size_t)i, channels = (size_t)c->channels;
    sight seen;
    if (!look(r, i, j, &seen) || !store_truth(&seen, pixel, how->albedo, c)) return;
    int paths = how->paths > seen.count ? how->paths : seen.count;
    for (int k = 0; k < how->lights; k++) {
        vec3 sum = {0, 0, 0};
        for (int s = 0; s < paths; s++)
            sum = vec3_add(sum, radiance(r, &seen.at[s % seen.count], seen.view[s % seen.count], &c->light[k]));
        sum = vec3_scale(sum, 1 / (float)paths);
        float rgb[3] = {sum.x, sum.y, sum.z};
        for (size_t ch = 0; ch < channels; ch++)
            c->picture[k].wide[pixel * channels + ch] = code_of(how, rgb[ch]);
    }
}

/* ---- the whole ---- */

static void render_row(rendering *r, int j)
{
    rng shared = rng_at(1, 2, 3);
    r->spread = sequence_of(&shared);
    r->random = rng_at(1, 2, 4 + (uint32_t)j);
    r->path = (uint32_t)j * (uint32_t)(r->how->size * r->how->lights * (r->how->paths + MOST_POINTS));
    for (int i = 0; i < r->how->size; i++)
        render_pixel(r, i, j);
}

static void render_rows(void *context, size_t begin, size_t end)
{
    job *all = context;
    rendering r = {.how = all->how, .capture = all->capture};
    status s = trace_scene_new(all->device, all->object, scene_surfaces_eval, 1e6, &r.scene);
    for (size_t j = begin; s == OK && j < end; j++)
        render_row(&r, (int)j);
    if (s == OK) {
        trace_scene_free(&r.scene);
        return;
    }
#pragma omp atomic write
    all->result = s;
}

static status allocate(const rendered *how, merlin_capture *c)
{
    size_t values = (size_t)how->size * (size_t)how->size * (size_t)c->channels;
    status s = pst_capture_reserve(c, (size_t)how->lights);
    if (s == OK) s = img_new(&c->mask, how->size, how->size, 1);
    if (s == OK) s = img_new(&c->normal_true, how->size, how->size, 3);
    if (s == OK) s = img_new(&c->depth_true, how->size, how->size, 1);
    if (s == OK && how->albedo) s = img_new(how->albedo, how->size, how->size, 3);
    if (s != OK) return s;
    for (int k = 0; k < how->lights; k++) {
        c->picture[k].wide = calloc(values, sizeof(uint16_t));
        if (!c->picture[k].wide) return fail(MERLIN_NO_MEMORY, "no memory for %d pictures", how->lights);
        c->light[k] = light_of(how, k);
    }
    return OK;
}

status rendered_capture(const rendered *how, const scene_object *object, merlin_capture *out)
{
    *out = (merlin_capture){.width = how->size,
                            .height = how->size,
                            .channels = how->grey ? 1 : 3,
                            .lighting = is_near(how) ? MERLIN_NEAR_LIGHTS : MERLIN_DISTANT_LIGHTS,
                            .intensities_known = true,
                            .camera = is_near(how) ? pinhole_of(how->size, how->size, how->fov) : (pinhole){0}};
    job all = {.how = how, .object = object, .capture = out, .result = OK};
    if (how->albedo) *how->albedo = (img){0};
    status s = allocate(how, out);
    if (s == OK) s = trace_device_new(&all.device);
    if (s == OK) {
        parallel_blocks((size_t)how->size, render_rows, &all);
        trace_device_free(all.device);
        s = all.result == OK ? OK : fail(all.result, "cannot trace a %s", object->shape);
    }
    if (s == OK && is_near(how)) out->camera.distance = (float)img_mean_within(&out->depth_true, &out->mask);
    if (s != OK) pst_capture_free(out);
    if (s != OK && how->albedo) img_free(how->albedo);
    return s;
}
