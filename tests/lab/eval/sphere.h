/* SPDX-License-Identifier: MIT */
/* A sphere as a sample in closed form: what a test needs of the renderer without the renderer. */
#ifndef MERLIN_TESTS_EVAL_SPHERE_H
#define MERLIN_TESTS_EVAL_SPHERE_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "lab/render/sample.h"
#include "optics/camera.h"
#include "optics/light.h"

typedef struct sphere {
    vec3 centre;
    float radius, albedo[3], roughness;
    int size;
} sphere;

static inline void sphere_pixel(const sphere *of, sample *s, const camera *view, int x, int y)
{
    vec3 d = camera_ray(view, (float)x + 0.5f, (float)y + 0.5f);
    float along = vec3_dot(d, of->centre);
    float inside = along * along - vec3_dot(of->centre, of->centre) + of->radius * of->radius;
    if (inside <= 0) return;
    vec3 p = vec3_scale(d, along - sqrtf(inside));
    vec3 n = vec3_scale(vec3_sub(p, of->centre), 1 / of->radius);
    shade_input in = {.albedo = {of->albedo[0], of->albedo[1], of->albedo[2]},
                      .roughness = of->roughness,
                      .normal = n,
                      .depth = -p.z,
                      .ray = camera_point(view, (float)x + 0.5f, (float)y + 0.5f, 1),
                      .light = s->light,
                      .power = s->light_power};
    vec3 radiance = shade_point(&in);
    float *albedo = img_at(&s->albedo, x, y), *normal = img_at(&s->normal, x, y), *direct = img_at(&s->direct, x, y);
    for (int c = 0; c < 3; c++)
        albedo[c] = of->albedo[c];
    normal[0] = n.x;
    normal[1] = n.y;
    normal[2] = n.z;
    direct[0] = radiance.x;
    direct[1] = radiance.y;
    direct[2] = radiance.z;
    *img_at(&s->roughness, x, y) = of->roughness;
    *img_at(&s->depth, x, y) = -p.z;
    *img_at(&s->mask, x, y) = 1;
}

/* Without indirect light; with target_count path-traced targets that are the flash picture itself. */
static inline status sphere_sample(const sphere *of, int target_count, sample *out)
{
    *out = (sample){.light_power = 5.95f, .fov = 60, .generator_version = SAMPLE_GENERATOR_VERSION, .shape = "union"};
    status s = img_new(&out->albedo, of->size, of->size, 3);
    if (s == OK) s = img_new(&out->normal, of->size, of->size, 3);
    if (s == OK) s = img_new(&out->roughness, of->size, of->size, 1);
    if (s == OK) s = img_new(&out->depth, of->size, of->size, 1);
    if (s == OK) s = img_new(&out->mask, of->size, of->size, 1);
    if (s == OK) s = img_new(&out->direct, of->size, of->size, 3);
    if (s == OK) s = img_new(&out->indirect, of->size, of->size, 3);
    if (s == OK) s = img_new(&out->env, of->size, of->size, 3);
    if (s != OK) return s;
    camera view = {.width = of->size, .height = of->size, .fov = out->fov};
    for (int y = 0; y < of->size; y++)
        for (int x = 0; x < of->size; x++)
            sphere_pixel(of, out, &view, x, y);
    if (!target_count) return OK;
    out->targets = calloc((size_t)target_count, sizeof *out->targets);
    if (!out->targets) return fail(MERLIN_NO_MEMORY, "no memory");
    out->target_count = target_count;
    for (int i = 0; s == OK && i < target_count; i++) {
        s = img_copy(&out->targets[i].direct, &out->direct);
        if (s == OK) s = img_copy(&out->targets[i].indirect, &out->indirect);
    }
    return s;
}

#endif
