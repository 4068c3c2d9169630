/* SPDX-License-Identifier: MIT */
/* Captures with known answers: a bumpy relief or a sphere seen from far away under distant lights, with cast shadows by
 * marching, and a sphere before a perspective camera under near lights. Heights and normals are in closed form. */
#ifndef MERLIN_TESTS_STEREO_RELIEF_H
#define MERLIN_TESTS_STEREO_RELIEF_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "optics/brdf.h"
#include "stereo/methods/solve.h"

typedef struct relief {
    int size, lights, channels;
    float bump;     /* height of the bumps, pixels; 0: a sphere that fills the picture */
    float specular; /* multiplies the GGX lobe; 0: Lambert */
    float roughness;
    float facets; /* slopes' spread of Oren & Nayar's rough matte surface, radians; 0: Lambert's law */
    float exposure;
    bool cast_shadows;
} relief;

static inline float relief_height(const relief *r, float x, float y)
{
    float s = 6.2831853f / (float)r->size;
    return r->bump * (sinf(2 * s * x + 0.5f) * cosf(1.5f * s * y) + 0.5f * sinf(4 * s * y + 0.3f * s * x));
}

/* False outside the object. y up, from the picture's middle. */
static inline bool relief_normal(const relief *r, float x, float y, vec3 *n)
{
    if (r->bump > 0) {
        float d = 0.01f;
        *n = vec3_normalize(vec3_make((relief_height(r, x - d, y) - relief_height(r, x + d, y)) / (2 * d),
                                      (relief_height(r, x, y - d) - relief_height(r, x, y + d)) / (2 * d), 1));
        return true;
    }
    float radius = 0.48f * (float)r->size, z2 = radius * radius - x * x - y * y;
    /* up to 75 degrees from the camera, as far as lights of the front reach */
    if (z2 < 0.067f * radius * radius) return false;
    *n = vec3_scale(vec3_make(x, y, sqrtf(z2)), 1 / radius);
    return true;
}

static inline bool relief_shadowed(const relief *r, float x, float y, vec3 l)
{
    if (!r->cast_shadows || r->bump <= 0) return false;
    float z = relief_height(r, x, y) + 0.02f, top = 1.5f * r->bump;
    for (float t = 0.3f; z + t * l.z < top; t += 0.3f)
        if (relief_height(r, x + t * l.x, y + t * l.y) > z + t * l.z) return true;
    return false;
}

/* What a rough matte surface reflects of what a smooth one would, seen from +z (Oren & Nayar, SIGGRAPH 1994, the
 * qualitative model). */
static inline float relief_rough(float facets, vec3 n, vec3 l)
{
    float square = facets * facets, n_l = fminf(vec3_dot(n, l), 1), n_v = fminf(n.z, 1);
    vec3 along_l = vec3_fma(l, -n_l, n), along_v = vec3_fma(vec3_make(0, 0, 1), -n_v, n);
    float turn = vec3_dot(along_l, along_v) / fmaxf(vec3_length(along_l) * vec3_length(along_v), 1e-6f);
    float steep = acosf(fminf(n_l, n_v)), flat = acosf(fmaxf(n_l, n_v));
    return 1 - 0.5f * square / (square + 0.33f) +
           0.45f * square / (square + 0.09f) * fmaxf(turn, 0) * sinf(steep) * tanf(flat);
}

static inline float relief_radiance(const relief *r, float albedo, vec3 n, vec3 l)
{
    vec3 v = {0, 0, 1};
    float n_l = vec3_dot(n, l);
    if (n_l <= 0) return 0;
    float lobe = r->specular > 0 ? r->specular * brdf_specular(r->roughness, n, l, v) : 0;
    float matte = r->facets > 0 ? relief_rough(r->facets, n, l) : 1;
    return (matte * albedo / PI + lobe) * n_l;
}

/* Count directions within about 70 degrees of the camera, on a spiral. */
static inline vec3 relief_light(int i, int count)
{
    float z = 1 - 0.66f * ((float)i + 0.5f) / (float)count, s = sqrtf(1 - z * z), phi = 2.3999632f * (float)i;
    return vec3_make(s * cosf(phi), s * sinf(phi), z);
}

static inline void capture_new(merlin_capture *c, int size, int lights, int channels)
{
    *c = (merlin_capture){
        .width = size, .height = size, .channels = channels, .count = lights, .intensities_known = true};
    assert_int_equal(img_new(&c->mask, size, size, 1), OK);
    assert_int_equal(img_new(&c->normal_true, size, size, 3), OK);
    assert_int_equal(img_new(&c->depth_true, size, size, 1), OK);
    c->light = calloc((size_t)lights, sizeof *c->light);
    c->picture = calloc((size_t)lights, sizeof *c->picture);
    for (int k = 0; k < lights; k++) {
        c->picture[k].wide = calloc((size_t)size * (size_t)size * (size_t)channels, sizeof(uint16_t));
        c->light[k].intensity[0] = c->light[k].intensity[1] = c->light[k].intensity[2] = 1;
    }
}

static inline void capture_drop(merlin_capture *c)
{
    for (int k = 0; k < c->count; k++)
        pst_plane_free(&c->picture[k]);
    free(c->picture);
    free(c->light);
    img_free(&c->mask);
    img_free(&c->normal_true);
    img_free(&c->depth_true);
}

static inline uint16_t relief_code(float radiance)
{
    float code = radiance * 65535 + 0.5f;
    return code >= 65535 ? 65535 : (uint16_t)code;
}

static inline void relief_capture(const relief *r, merlin_capture *c)
{
    capture_new(c, r->size, r->lights, r->channels);
    for (int k = 0; k < r->lights; k++)
        vec3_put(relief_light(k, r->lights), c->light[k].direction);
    for (int j = 0; j < r->size; j++) {
        for (int i = 0; i < r->size; i++) {
            float x = (float)i + 0.5f - 0.5f * (float)r->size, y = 0.5f * (float)r->size - (float)j - 0.5f;
            vec3 n;
            if (!relief_normal(r, x, y, &n)) continue;
            size_t at = (size_t)j * (size_t)r->size + (size_t)i;
            c->mask.data[at] = 1;
            memcpy(c->normal_true.data + 3 * at, &(float[3]){n.x, n.y, n.z}, 3 * sizeof(float));
            for (int k = 0; k < r->lights; k++) {
                vec3 l = vec3_of(c->light[k].direction);
                if (relief_shadowed(r, x, y, l)) continue;
                for (int ch = 0; ch < r->channels; ch++) {
                    float albedo = (0.5f + 0.2f * sinf(0.2f * x + (float)ch)) * (ch == 1 ? 0.6f : 1);
                    c->picture[k].wide[at * (size_t)r->channels + (size_t)ch] =
                        relief_code(r->exposure * relief_radiance(r, albedo, n, l));
                }
            }
        }
    }
}

/* Mean angle over the mask, degrees. */
static inline double mean_angle(const merlin_capture *c, const img *normal)
{
    double sum = 0, count = 0;
    for (size_t i = 0; i < (size_t)c->width * (size_t)c->height; i++) {
        if (c->mask.data[i] < 0.5f) continue;
        const float *a = c->normal_true.data + 3 * i, *b = normal->data + 3 * i;
        double x = (double)a[1] * b[2] - (double)a[2] * b[1], y = (double)a[2] * b[0] - (double)a[0] * b[2];
        double z = (double)a[0] * b[1] - (double)a[1] * b[0], dot = (double)a[0] * b[0] + (double)a[1] * b[1];
        sum += atan2(sqrt(x * x + y * y + z * z), dot + (double)a[2] * b[2]) * 57.29577951;
        count++;
    }
    return sum / count;
}

static inline double solve_angle(const merlin_capture *c, merlin_stereo_method method)
{
    merlin_surface surface;
    assert_int_equal(pst_solve(c, &(merlin_stereo_params){.method = method}, &surface), OK);
    double angle = mean_angle(c, &surface.normal);
    merlin_surface_free(&surface);
    return angle;
}

#endif
