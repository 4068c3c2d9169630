/* SPDX-License-Identifier: MIT */
#include "estimate/light/relight_env.h"

#include <math.h>
#include <stdbool.h>

#include "base/parallel.h"
#include "estimate/light/env_lights.h"
#include "estimate/surface/fill.h"
#include "image/resize.h"
#include "optics/ambient.h"
#include "optics/camera.h"

/* Radius of the neighbourhood for bounces, as a fraction of the frame. */
enum { FRAME_BY_RADIUS = 24 };

typedef struct pixel {
    vec3 albedo, normal, view;
    float roughness;
    float x, y; /* place in shares of the frame */
} pixel;

typedef struct job job;
struct job {
    const surface *s;
    camera eye;
    const float (*sh)[3];
    const horizon *hidden;
    const env_light *lights;
    int light_count;
    vec3 (*shade)(const job *j, const pixel *p);
    bool share; /* whether the result is a share of light, not multiplied by coverage */
    img *image;
};

static vec3 at3(const img *image, size_t i)
{
    return vec3_of(image->data + 3 * i);
}

static void add_rows(void *context, size_t begin, size_t end)
{
    const job *j = context;
    const surface *s = j->s;
    size_t width = (size_t)s->mask.width;
    for (size_t i = begin * width; i < end * width; i++) {
        float coverage = s->mask.data[i];
        if (!(coverage > 0)) continue;
        size_t x = i % width, y = i / width;
        vec3 ray = camera_ray(&j->eye, (float)x + 0.5f, (float)y + 0.5f);
        pixel p = {at3(&s->albedo, i),
                   at3(&s->normal, i),
                   vec3_scale(ray, -1),
                   s->roughness.data[i],
                   ((float)x + 0.5f) / (float)width,
                   ((float)y + 0.5f) / (float)s->mask.height};
        float *out = j->image->data + 3 * i;
        vec3_put(vec3_fma(vec3_of(out), j->share ? 1 : coverage, j->shade(j, &p)), out);
    }
}

static void add(job *j)
{
    j->eye = surface_camera(j->s);
    parallel_blocks((size_t)j->s->mask.height, add_rows, j);
}

/* ---- by coefficients ---- */

static vec3 shade_ambient(const job *j, const pixel *p)
{
    return ambient_diffuse(j->sh, p->albedo, p->normal);
}

void surface_add_ambient(const surface *s, const float sh[9][3], img *image)
{
    add(&(job){.s = s, .sh = sh, .shade = shade_ambient, .image = image});
}

static vec3 shade_highlights(const job *j, const pixel *p)
{
    return ambient_specular(j->sh, p->roughness, p->normal, p->view);
}

void surface_add_ambient_highlights(const surface *s, const float sh[9][3], img *image)
{
    add(&(job){.s = s, .sh = sh, .shade = shade_highlights, .image = image});
}

/* ---- the part that arrives ---- */

static float share_of(float part, float whole)
{
    return whole > 1e-12f ? fminf(part / whole, 1) : 1;
}

static vec3 shade_seen(const job *j, const pixel *p)
{
    vec3 seen = {0, 0, 0}, all = {0, 0, 0};
    horizon_view edge;
    horizon_at(j->hidden, p->x, p->y, &edge);
    for (int i = 0; i < j->light_count; i++) {
        const env_light *l = &j->lights[i];
        float cosine = vec3_dot(p->normal, l->direction);
        if (!(cosine > 0)) continue;
        all = vec3_fma(all, cosine, l->power);
        seen = vec3_fma(seen, cosine * horizon_sees(&edge, l->direction, l->solid_angle), l->power);
    }
    return vec3_make(share_of(seen.x, all.x), share_of(seen.y, all.y), share_of(seen.z, all.z));
}

/* Computes the mean radiance of the lit surfaces around every pixel, and their number. */
static status lit_nearby(const surface *s, const img *seen, const float sh[9][3], img *out)
{
    img lit = {0};
    int width = s->mask.width, height = s->mask.height;
    status result = img_new(&lit, width, height, 3);
    if (result == OK) result = img_new(out, width, height, 4);
    if (result == OK) {
        surface_add_ambient(s, sh, &lit);
        for (size_t i = 0; i < (size_t)width * (size_t)height; i++) {
            for (size_t c = 0; c < 3; c++)
                out->data[4 * i + c] = lit.data[3 * i + c] * seen->data[3 * i + c];
            out->data[4 * i + 3] = s->mask.data[i];
        }
        result = img_box_sums(out, width / FRAME_BY_RADIUS);
    }
    img_free(&lit);
    return result;
}

/* Adds a bounce: where a surface hides the environment it reflects light itself, about as much as it sends to the
 * camera nearby. */
static status add_bounce(const surface *s, const float sh[9][3], img *seen)
{
    img nearby = {0};
    status result = lit_nearby(s, seen, sh, &nearby);
    size_t count = result == OK ? (size_t)s->mask.width * (size_t)s->mask.height : 0;
    for (size_t i = 0; i < count; i++) {
        if (!(s->mask.data[i] > 0)) continue;
        vec3 e = sh_irradiance(sh, at3(&s->normal, i));
        const float *sum = nearby.data + 4 * i, open[3] = {e.x, e.y, e.z};
        for (size_t c = 0; c < 3; c++) {
            float *share = &seen->data[3 * i + c];
            *share += (1 - *share) * share_of(sum[c] * PI, sum[3] * open[c]);
        }
    }
    img_free(&nearby);
    return result;
}

status surface_arriving_light(const surface *s, const horizon *h, const env_map *env, img *share)
{
    env_light lights[ENV_LIGHTS_MOST];
    status result = img_new(share, s->mask.width, s->mask.height, 3);
    if (result != OK) return result;
    job j = {.s = s, .hidden = h, .lights = lights, .shade = shade_seen, .share = true, .image = share};
    j.light_count = env_lights(env, lights);
    add(&j);
    result = add_bounce(s, (const float(*)[3])env->sh, share);
    return result == OK ? fill_outside(share, &s->mask) : result;
}

status surface_add_shadowed_environment(const surface *s, const surface *coarse, const horizon *h, const env_map *env,
                                        img *image)
{
    img diffuse = {0}, share = {0};
    status result = img_new(&diffuse, image->width, image->height, 3);
    if (result == OK) result = surface_arriving_light(coarse, h, env, &share);
    if (result == OK) {
        surface_add_ambient(s, (const float(*)[3])env->sh, &diffuse);
        shadow_darken(&share, &diffuse);
        img_add(&diffuse, image);
        if (!s->matte) surface_add_reflections(s, env, h, image);
    }
    img_free(&diffuse);
    img_free(&share);
    return result;
}
