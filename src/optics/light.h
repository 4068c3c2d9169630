/* SPDX-License-Identifier: MIT */
/* Radiance of a surface point under a point light, seen by the camera at the origin, and its derivative.
 *
 *     shade_input in = {albedo, roughness, normal, depth, camera_point(&c, x, y, 1), light, LIGHT_POWER};
 *     vec3 radiance = shade_point(&in);
 *     shade_gradient g = shade_point_gradient(&in, d_loss_d_radiance);
 *
 * radiance = Φ f(l, v) max(0, n·l) / d², with l and d from the point to the light and v to the origin. A light at (0,
 * 0, 0) is a flash beside the lens. Both functions have no branches and no library calls, so that loops over pixels
 * vectorize, and are finite for every finite input (a pixel outside the mask may hold zeros). */
#ifndef MERLIN_OPTICS_LIGHT_H
#define MERLIN_OPTICS_LIGHT_H

#include <stdbool.h>

#include "base/number.h"
#include "optics/brdf.h"

/* Power Φ of the flash in the training data, and so of the light that networks predict. */
#define LIGHT_POWER ((real)5.95)
/* Smallest squared distance to a light; a light inside the surface is not infinitely bright. */
#define LIGHT_MIN_DISTANCE2 ((real)1e-6)

/* The middle of an object in camera space: it is scaled to stand here (docs/conventions.md). */
static const vec3 object_middle = {0, 0, -1};

/* A lamp. A near one emits power Φ from a position. A distant one's light is parallel, and everywhere as bright as a
 * near one's at distance 1: at the object's centre it equals a near one on the frontal hemisphere. */
typedef struct lamp {
    vec3 at;      /* position in camera space; of a distant lamp the unit direction toward it */
    bool distant; /* infinitely far */
    vec3 tint;    /* power by channel, in units of LIGHT_POWER */
} lamp;

static inline lamp lamp_at(vec3 place)
{
    return (lamp){place, false, {1, 1, 1}};
}

static inline lamp lamp_toward(vec3 direction)
{
    return (lamp){vec3_normalize(direction), true, {1, 1, 1}};
}

/* The light on an object: a point light, and an environment. */
typedef struct illumination {
    vec3 place;          /* position of the point light in camera space */
    const real (*sh)[3]; /* nine coefficients of the environment (optics/sh.h); NULL: dark */
} illumination;

typedef struct shade_input {
    vec3 albedo;    /* linear, [0, 1] */
    real roughness; /* [0.03, 1] */
    vec3 normal;    /* unit, toward the camera */
    real depth;     /* -z of the point, positive */
    vec3 ray;       /* the pixel's camera_point at depth 1: (x, y, -1) */
    vec3 light;     /* position in camera space */
    real power;     /* Φ */
} shade_input;

/* Derivatives of the loss by each input. The normal counts as three independent numbers. */
typedef struct shade_gradient {
    vec3 albedo;
    real roughness;
    vec3 normal;
    real depth;
} shade_gradient;

/* Directions, cosines and factors of the specular term, which both functions need. */
typedef struct shade_terms {
    vec3 to_light, l, v, h;
    real distance2, distance, half_length; /* half_length = |l + v| */
    real n_l, n_v, n_h, v_h;               /* cosines, clamped to [0, 1] */
    real alpha2, k, base, fresnel, specular;
} shade_terms;

static inline shade_terms shade_terms_of(const shade_input *in)
{
    shade_terms t;
    t.to_light = vec3_fma(in->light, -in->depth, in->ray);
    real squared = vec3_dot(t.to_light, t.to_light);
    t.distance2 = squared > LIGHT_MIN_DISTANCE2 ? squared : LIGHT_MIN_DISTANCE2;
    t.distance = sqrt(t.distance2);
    t.l = vec3_scale(t.to_light, 1 / t.distance);
    t.v = vec3_scale(in->ray, -1 / sqrt(vec3_dot(in->ray, in->ray)));
    vec3 sum = vec3_add(t.l, t.v);
    real sum2 = vec3_dot(sum, sum);
    t.half_length = sqrt(sum2 > (real)1e-12 ? sum2 : (real)1e-12);
    t.h = vec3_scale(sum, 1 / t.half_length);
    t.n_l = clamp(vec3_dot(in->normal, t.l), 0, 1);
    t.n_v = clamp(vec3_dot(in->normal, t.v), 0, 1);
    t.n_h = clamp(vec3_dot(in->normal, t.h), 0, 1);
    t.v_h = clamp(vec3_dot(t.v, t.h), 0, 1);
    t.alpha2 = brdf_alpha2(in->roughness);
    t.k = brdf_k(in->roughness);
    t.base = brdf_distribution_base(t.alpha2, t.n_h);
    t.fresnel = brdf_fresnel(t.v_h);
    t.specular = t.alpha2 / (PI * t.base * t.base) * t.fresnel * brdf_visibility(t.k, t.n_l, t.n_v);
    return t;
}

/* Returns the radiance toward the camera. */
static inline vec3 shade_point(const shade_input *in)
{
    shade_terms t = shade_terms_of(in);
    real scale = in->power * t.n_l / t.distance2;
    return vec3_make((in->albedo.x / PI + t.specular) * scale, (in->albedo.y / PI + t.specular) * scale,
                     (in->albedo.z / PI + t.specular) * scale);
}

/* Returns the radiance of the diffuse part alone. */
static inline vec3 shade_point_matte(const shade_input *in)
{
    shade_terms t = shade_terms_of(in);
    return vec3_scale(in->albedo, in->power * t.n_l / (PI * t.distance2));
}

/* Returns the derivative of the clamp of a cosine: 1 where x is strictly inside (0, 1), else 0. */
static inline real shade_inside(real x)
{
    return x > 0 && x < 1 ? (real)1 : (real)0;
}

/* Returns d(specular)/d(roughness), from D (through α²) and from the visibility (through k). */
static inline real shade_specular_by_roughness(const shade_terms *t, real roughness)
{
    real r = clamp(roughness, BRDF_MIN_ROUGHNESS, 1);
    real inside = roughness >= BRDF_MIN_ROUGHNESS && roughness <= 1 ? (real)1 : (real)0;
    real by_alpha2 = 1 / t->alpha2 - 2 * t->n_h * t->n_h / t->base;
    real by_k = -(1 - t->n_l) / (t->n_l * (1 - t->k) + t->k) - (1 - t->n_v) / (t->n_v * (1 - t->k) + t->k);
    return inside * t->specular * (by_alpha2 * 4 * r * r * r + by_k * (r + 1) / 4);
}

/* Returns the gradient of d_radiance · shade_point(in). Where a cosine is clamped its derivative is zero; beyond the
 * terminator that holds for all of them. */
static inline shade_gradient shade_point_gradient(const shade_input *in, vec3 d_radiance)
{
    shade_terms t = shade_terms_of(in);
    shade_gradient g;
    real scale = in->power * t.n_l / t.distance2;
    real sum = d_radiance.x + d_radiance.y + d_radiance.z;
    real f = vec3_dot(d_radiance, in->albedo) / PI + sum * t.specular;
    real d_specular = sum * scale;
    g.albedo = vec3_scale(d_radiance, scale / PI);
    g.roughness = d_specular * shade_specular_by_roughness(&t, in->roughness);

    real weighted = d_specular * t.specular;
    real by_n_l = f * in->power / t.distance2 - weighted * (1 - t.k) / (t.n_l * (1 - t.k) + t.k);
    real by_n_v = -weighted * (1 - t.k) / (t.n_v * (1 - t.k) + t.k);
    real by_n_h = weighted * 4 * t.n_h * (1 - t.alpha2) / t.base;
    real exponent_slope = (real)0.69314718055994530942 * ((real)-11.10946 * t.v_h - (real)6.98316);
    real by_v_h = weighted / t.fresnel * (t.fresnel - BRDF_F0) * exponent_slope;
    by_n_l *= shade_inside(vec3_dot(in->normal, t.l));
    by_n_v *= shade_inside(vec3_dot(in->normal, t.v));
    by_n_h *= shade_inside(vec3_dot(in->normal, t.h));
    g.normal = vec3_fma(vec3_fma(vec3_scale(t.l, by_n_l), by_n_v, t.v), by_n_h, t.h);

    /* depth moves the point along the ray: l and h turn, the distance changes, v stays */
    vec3 by_h = vec3_fma(vec3_scale(in->normal, by_n_h), by_v_h, t.v);
    vec3 turn_h = vec3_scale(vec3_fma(by_h, -vec3_dot(t.h, by_h), t.h), 1 / t.half_length);
    vec3 by_l = vec3_fma(turn_h, by_n_l, in->normal);
    vec3 turn_l = vec3_scale(vec3_fma(by_l, -vec3_dot(t.l, by_l), t.l), 1 / t.distance);
    real fall_off = 2 * f * scale / t.distance2 * vec3_dot(t.to_light, in->ray);
    g.depth = fall_off - vec3_dot(turn_l, in->ray);
    return g;
}

/* Returns a position for a target light: on the hemisphere of radius 1 about (0, 0, -1) that faces the camera, cosθ
 * uniform (Sang & Chandraker 2020); u1, u2 in [0, 1). */
static inline vec3 frontal_light(real u1, real u2)
{
    real cosine = u1, sine = sqrt(1 - cosine * cosine), phi = 2 * PI * u2;
    return vec3_make(sine * cos(phi), sine * sin(phi), cosine - 1);
}

#endif
