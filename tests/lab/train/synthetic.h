/* SPDX-License-Identifier: MIT */
/* Samples of a few pixels for the tests of training: a sphere with a two-coloured albedo under the flash, lit by the
 * project's own physics, written as sample files. */
#ifndef MERLIN_TESTS_SYNTHETIC_H
#define MERLIN_TESTS_SYNTHETIC_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "base/file.h"
#include "lab/render/sample.h"
#include "optics/ambient.h"
#include "optics/camera.h"
#include "optics/light.h"

static inline void put(const img *image, int x, int y, vec3 v)
{
    float *p = img_at(image, x, y);
    p[0] = v.x;
    p[1] = v.y;
    p[2] = v.z;
}

/* Sets a smooth sky, which nine coefficients represent exactly; another one for each sample. */
static inline void sphere_sky(int which, float sh[9][3])
{
    for (int i = 0; i < 27; i++)
        sh[i / 3][i % 3] = i < 3 ? 2.5f + 0.2f * (float)i : 0.3f * sinf((float)(3 * i + 5 * which));
}

static inline vec3 sphere_environment(const sample *s, vec3 albedo, vec3 normal, vec3 ray)
{
    const float(*sh)[3] = (const float(*)[3])s->sh;
    vec3 diffuse = vec3_mul(albedo, vec3_scale(sh_irradiance(sh, normal), 1 / PI));
    return vec3_add(diffuse, ambient_specular(sh, 0.5f, normal, vec3_scale(vec3_normalize(ray), -1)));
}

static inline void sphere_pixel(sample *s, const camera *c, int x, int y, int which)
{
    const float radius = 0.3f + 0.02f * (float)which;
    vec3 centre = {0.03f * (float)which, -0.05f, -1}, ray = camera_point(c, (float)x + 0.5f, (float)y + 0.5f, 1);
    float a = vec3_dot(ray, ray), b = vec3_dot(ray, centre);
    float d = b * b - a * (vec3_dot(centre, centre) - radius * radius);
    if (d <= 0) return;
    vec3 point = vec3_scale(ray, (b - sqrtf(d)) / a);
    vec3 normal = vec3_scale(vec3_sub(point, centre), 1 / radius);
    vec3 albedo = (x / 8 + which) % 2 ? vec3_make(0.7f, 0.3f, 0.2f) : vec3_make(0.2f, 0.4f, 0.6f);
    shade_input in = {albedo, 0.5f, normal, -point.z, ray, {0, 0, 0}, LIGHT_POWER};
    put(&s->albedo, x, y, albedo);
    put(&s->normal, x, y, normal);
    put(&s->direct, x, y, shade_point(&in));
    put(&s->env, x, y, sphere_environment(s, albedo, normal, ray));
    /* partly below the smallest normal half float: arithmetic on such numbers must not differ between threads */
    put(&s->indirect, x, y, vec3_scale(albedo, y % 2 ? 5e-5f : 0.05f));
    *img_at(&s->roughness, x, y) = 0.5f;
    *img_at(&s->depth, x, y) = -point.z;
    *img_at(&s->mask, x, y) = 1;
}

static inline void sphere_write(const char *folder, int size, int which)
{
    sample s = {
        .light_power = LIGHT_POWER, .fov = 60, .index = (uint64_t)which, .generator_version = 1, .shape = "union"};
    img *const three[] = {&s.albedo, &s.normal, &s.direct, &s.indirect, &s.env};
    img *const one[] = {&s.roughness, &s.depth, &s.mask};
    for (int i = 0; i < 5; i++)
        assert_int_equal(img_new(three[i], size, size, 3), OK);
    for (int i = 0; i < 3; i++)
        assert_int_equal(img_new(one[i], size, size, 1), OK);
    sphere_sky(which, s.sh);
    camera c = {.width = size, .height = size, .fov = 60};
    for (int y = 0; y < size; y++)
        for (int x = 0; x < size; x++)
            sphere_pixel(&s, &c, x, y, which);
    char *path = sample_path(folder, (uint64_t)which);
    if (sample_write(path, &s) != OK) fail_msg("%s", status_message());
    free(path);
    sample_free(&s);
}

#endif
