/* SPDX-License-Identifier: MIT */
#include "lab/train/samples/prepare.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "optics/ambient.h"
#include "optics/camera.h"
#include "optics/light.h"

vec3 train_draw_light(rng *r)
{
    float u1 = rng_uniform(r), u2 = rng_uniform(r);
    return frontal_light(u1, u2);
}

float train_draw_strength(rng *r)
{
    return expf(rng_range(r, logf(0.1f), 0));
}

float train_draw_target_strength(float dark_share, rng *r)
{
    float strength = train_draw_strength(r);
    return rng_uniform(r) < dark_share ? 0 : strength;
}

void train_render(const train_view *maps, vec3 light, float *out)
{
    int size = maps->size;
    const camera c = maps->lens.width ? maps->lens : (camera){.width = size, .height = size, .fov = CAMERA_FOV};
    memset(out, 0, 3 * (size_t)size * (size_t)size * sizeof(float));
    for (int y = 0; y < size; y++) {
        for (int x = 0; x < size; x++) {
            size_t i = (size_t)y * (size_t)size + (size_t)x;
            if (maps->mask[i] <= 0.5f) continue;
            shade_input in = {.albedo = vec3_of(maps->albedo + 3 * i),
                              .roughness = maps->roughness[i],
                              .normal = vec3_of(maps->normal + 3 * i),
                              .depth = maps->depth[i],
                              .ray = camera_point(&c, (float)x + 0.5f, (float)y + 0.5f, 1),
                              .light = light,
                              .power = LIGHT_POWER};
            vec3 radiance = shade_point(&in);
            out[3 * i] = fminf(radiance.x, 1.0f);
            out[3 * i + 1] = fminf(radiance.y, 1.0f);
            out[3 * i + 2] = fminf(radiance.z, 1.0f);
        }
    }
}

static void add3(float *to, size_t i, vec3 v)
{
    to[3 * i] += v.x;
    to[3 * i + 1] += v.y;
    to[3 * i + 2] += v.z;
}

void train_add_environment(const train_view *maps, const float sh[9][3], float *image)
{
    size_t pixels = (size_t)maps->size * (size_t)maps->size;
    for (size_t i = 0; i < pixels; i++) {
        if (maps->mask[i] <= 0) continue;
        vec3 white = vec3_scale(sh_irradiance(sh, vec3_of(maps->normal + 3 * i)), maps->mask[i] / PI);
        add3(image, i, vec3_mul(white, vec3_of(maps->albedo + 3 * i)));
    }
}

/* Subtracts what the specular lobe reflects of the environment, times coverage. */
static void subtract_highlights(const train_view *maps, const float sh[9][3], float *image)
{
    int size = maps->size;
    camera c = {.width = size, .height = size, .fov = CAMERA_FOV};
    for (int y = 0; y < size; y++) {
        for (int x = 0; x < size; x++) {
            size_t i = (size_t)y * (size_t)size + (size_t)x;
            if (maps->mask[i] <= 0) continue;
            vec3 view = vec3_scale(camera_ray(&c, (float)x + 0.5f, (float)y + 0.5f), -1);
            vec3 reflected = ambient_specular(sh, maps->roughness[i], vec3_of(maps->normal + 3 * i), view);
            add3(image, i, vec3_scale(reflected, -maps->mask[i]));
        }
    }
}

/* Scales environment image and coefficients to the strength of this presentation. */
static void scale_environment(const train_view *v, float strength)
{
    size_t values = 3 * (size_t)v->size * (size_t)v->size;
    for (size_t i = 0; i < values; i++)
        v->env[i] *= strength;
    for (int i = 0; i < MODEL_SH; i++)
        v->sh[i] *= strength;
}

/* Adds the environment: direct gains what the rendering layer makes of it, indirect the remainder of the truth. That
 * remainder is limited: shadows do not remove more light than there was, and later bounces do not exceed the first, as
 * a larger remainder is a highlight that the coefficients do not describe. */
static void add_environment(const train_view *v, const float sh[9][3])
{
    size_t values = 3 * (size_t)v->size * (size_t)v->size;
    float *rest = v->env, *shaded = v->reconstruction; /* which is computed later */
    memset(shaded, 0, values * sizeof *shaded);
    train_add_environment(v, sh, shaded);
    subtract_highlights(v, sh, rest);
    for (size_t i = 0; i < values; i++) {
        v->direct[i] += shaded[i];
        v->indirect[i] += fminf(fmaxf(rest[i], 0) - shaded[i], fmaxf(shaded[i], 0));
    }
}

/* Adds the environment to the target, clipped as by the rendering layer. */
static void add_target_environment(const train_view *v, const float sh[9][3])
{
    size_t values = 3 * (size_t)v->size * (size_t)v->size;
    train_add_environment(v, sh, v->relit);
    for (size_t i = 0; i < values; i++)
        v->relit[i] = v->mask[i / 3] > 0.5f ? clamp(v->relit[i], 0.0f, 1.0f) : 0.0f;
    model_encode_sh(sh, v->target_sh);
}

static void clip_direct(const train_view *v)
{
    for (size_t i = 0; i < 3 * (size_t)v->size * (size_t)v->size; i++)
        v->direct[i] = fminf(v->direct[i], 1.0f);
}

/* Converts masks to binary, and maps to the network's ranges. */
static void convert(const train_view *v)
{
    size_t pixels = (size_t)v->size * (size_t)v->size;
    for (size_t i = 0; i < pixels; i++) {
        float seen = v->loss_mask[i];
        v->loss_mask[i] = v->mask[i] >= 0.999f ? seen : 0.0f; /* coverage was rounded to half */
        v->mask[i] = seen;
        v->roughness[i] = 2 * v->roughness[i] - 1;
    }
    for (size_t i = 0; i < 3 * pixels; i++) {
        v->reconstruction[i] = v->direct[i] + v->indirect[i];
        v->albedo[i] = 2 * v->albedo[i] - 1;
    }
}

void train_finish(const train_view *v, vec3 target)
{
    train_render(v, target, v->relit);
    clip_direct(v);
    convert(v);
    vec3_put(target, v->light);
}

status train_prepare(const train_view *v, bool global, const train_camera *lens, const train_lighting *lighting,
                     rng *noise)
{
    vec3 light = lighting->target;
    if (v->env) scale_environment(v, lighting->strength);
    status s = train_photograph(v, global, lens, noise);
    if (s != OK) return s;
    train_render(v, light, v->relit);
    clip_direct(v);
    if (v->env) {
        float sh[9][3];
        memcpy(sh, v->sh, sizeof sh);
        add_environment(v, (const float(*)[3])sh);
        model_encode_sh((const float(*)[3])sh, v->sh);
        add_target_environment(v, lighting->target_sh);
    }
    convert(v);
    vec3_put(light, v->light);
    return OK;
}
