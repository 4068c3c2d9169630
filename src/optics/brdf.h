/* SPDX-License-Identifier: MIT */
/* Microfacet BRDF of Karis 2013: diffuse albedo plus one GGX lobe with F0 = 0.05.
 *
 * It is the only definition: the path tracer, the network's rendering layer and the relighting all include this file,
 * so that a relit photograph obeys the same physics as the data the network learned from.
 *
 *     vec3 f = brdf_eval(albedo, roughness, n, l, v);
 *
 *     f = A/π + D F G / (4 (n·l)(n·v)),   α = R²,   k = (R + 1)²/8
 *     D = α² / (π ((n·h)²(α² − 1) + 1)²)
 *     F = F0 + (1 − F0) 2^((−5.55473 (v·h) − 6.98316)(v·h))
 *     G = G1(n·l) G1(n·v),                G1(x) = x / (x (1 − k) + k)
 *
 * G's numerators cancel the denominator of f, so that nothing here divides by n·l or n·v.
 *
 * The specular lobe alone conserves energy. The sum need not: the diffuse part is not reduced by what the lobe
 * reflects, so that a white surface (albedo near 1) can return more light than it receives. The published data are made
 * with this model, which is why it is kept. */
#ifndef MERLIN_OPTICS_BRDF_H
#define MERLIN_OPTICS_BRDF_H

#include <stdbool.h>

#include "base/number.h"
#include "base/vec.h"

#define BRDF_F0 ((real)0.05)
/* Smallest roughness that is evaluated; a narrower lobe is beyond the resolution of float. */
#define BRDF_MIN_ROUGHNESS ((real)0.03)

/* Returns α² = R⁴. */
static inline real brdf_alpha2(real roughness)
{
    real r = clamp(roughness, BRDF_MIN_ROUGHNESS, 1);
    return r * r * r * r;
}

static inline real brdf_k(real roughness)
{
    real r = clamp(roughness, BRDF_MIN_ROUGHNESS, 1);
    return (r + 1) * (r + 1) / 8;
}

/* Returns (n·h)²(α² − 1) + 1, rearranged to keep its precision near n·h = 1. */
static inline real brdf_distribution_base(real alpha2, real n_h)
{
    return (1 - n_h) * (1 + n_h) + n_h * n_h * alpha2;
}

/* Returns D in 1/sr; n·h in [0, 1]. */
static inline real brdf_distribution(real alpha2, real n_h)
{
    real base = brdf_distribution_base(alpha2, n_h);
    return alpha2 / (PI * base * base);
}

/* Returns 2^x for x in [-13, 0] to 1e-8, without a library call, so that loops over pixels vectorize: the series of
 * e^(x ln2 / 16), squared four times. */
static inline real brdf_exp2(real x)
{
    real t = x * (real)(0.69314718055994530942 / 16);
    real e = 1 + t / 9;
    e = 1 + t * e / 8;
    e = 1 + t * e / 7;
    e = 1 + t * e / 6;
    e = 1 + t * e / 5;
    e = 1 + t * e / 4;
    e = 1 + t * e / 3;
    e = 1 + t * e / 2;
    e = 1 + t * e;
    e *= e;
    e *= e;
    e *= e;
    return e * e;
}

/* Returns F; v·h in [0, 1]. */
static inline real brdf_fresnel(real v_h)
{
    return BRDF_F0 + (1 - BRDF_F0) * brdf_exp2(((real)-5.55473 * v_h - (real)6.98316) * v_h);
}

/* Returns G / (4 (n·l)(n·v)); n·l and n·v in [0, 1]. */
static inline real brdf_visibility(real k, real n_l, real n_v)
{
    return 1 / (4 * (n_l * (1 - k) + k) * (n_v * (1 - k) + k));
}

static inline vec3 brdf_half_vector(vec3 l, vec3 v)
{
    return vec3_normalize(vec3_add(l, v));
}

/* Returns the specular term of brdf_eval, in 1/sr. */
static inline real brdf_specular(real roughness, vec3 n, vec3 l, vec3 v)
{
    vec3 h = brdf_half_vector(l, v);
    real n_l = clamp(vec3_dot(n, l), 0, 1), n_v = clamp(vec3_dot(n, v), 0, 1);
    real n_h = clamp(vec3_dot(n, h), 0, 1), v_h = clamp(vec3_dot(v, h), 0, 1);
    return brdf_distribution(brdf_alpha2(roughness), n_h) * brdf_fresnel(v_h) *
           brdf_visibility(brdf_k(roughness), n_l, n_v);
}

/* Returns f(l, v) in 1/sr, for unit n, l, v with n·l > 0 and n·v > 0; albedo linear in [0, 1]; roughness in [0.03, 1].
 * The result is finite for every input; negative cosines count as zero, and the caller multiplies by max(0, n·l). */
static inline vec3 brdf_eval(vec3 albedo, real roughness, vec3 n, vec3 l, vec3 v)
{
    real s = brdf_specular(roughness, n, l, v);
    return vec3_make(albedo.x / PI + s, albedo.y / PI + s, albedo.z / PI + s);
}

/* ---- sampling -------------------------------------------------------------------------------------------------- */

/* Transforms from local coordinates (z along n) to the space of the unit vector n (Duff et al. 2017). */
static inline vec3 brdf_to_world(vec3 local, vec3 n)
{
    real sign = copysign((real)1, n.z);
    real a = -1 / (sign + n.z), b = n.x * n.y * a;
    vec3 t = {1 + sign * n.x * n.x * a, sign * b, -sign * n.x};
    vec3 s = {b, sign + n.y * n.y * a, -n.y};
    return vec3_fma(vec3_fma(vec3_scale(t, local.x), local.y, s), local.z, n);
}

/* Sets cosine and sine of u turns, u in [0, 1), to 1e-7, without a library call, so that loops over paths vectorize:
 * the series for a quarter of (u - 1/2) turns, doubled twice, plus half a turn. */
static inline void brdf_turn(real u, real *cosine, real *sine)
{
    real t = (u - (real)0.5) * (PI / 2), t2 = t * t;
    real s = t * (1 - t2 / 6 * (1 - t2 / 20 * (1 - t2 / 42 * (1 - t2 / 72 * (1 - t2 / 110)))));
    real c = 1 - t2 / 2 * (1 - t2 / 12 * (1 - t2 / 30 * (1 - t2 / 56 * (1 - t2 / 90))));
    real s2 = 2 * s * c, c2 = 1 - 2 * s * s;
    *sine = -2 * s2 * c2;
    *cosine = 2 * s2 * s2 - 1;
}

/* Returns a direction about n with density cosθ/π; u1, u2 in [0, 1). */
static inline vec3 brdf_sample_cosine(vec3 n, real u1, real u2)
{
    real r = sqrt(u1), c, s;
    brdf_turn(u2, &c, &s);
    return brdf_to_world(vec3_make(r * c, r * s, sqrt(1 - u1)), n);
}

/* Returns a half vector about n with density D (n·h) (Walter et al. 2007). */
static inline vec3 brdf_sample_half_vector(vec3 n, real alpha2, real u1, real u2)
{
    real cos2 = (1 - u1) / (1 + (alpha2 - 1) * u1), c, s;
    real sine = sqrt(clamp(1 - cos2, 0, 1));
    brdf_turn(u2, &c, &s);
    return brdf_to_world(vec3_make(sine * c, sine * s, sqrt(cos2)), n);
}

/* Returns the share of samples for the specular lobe: its part of the reflected light, limited so that both lobes get
 * samples. */
static inline real brdf_specular_share(vec3 albedo, vec3 n, vec3 v)
{
    real f = brdf_fresnel(clamp(vec3_dot(n, v), 0, 1));
    return clamp(f / (f + (albedo.x + albedo.y + albedo.z) / 3), (real)0.1, (real)0.9);
}

/* Returns the density of brdf_sample at l, in 1/sr. */
static inline real brdf_pdf(vec3 albedo, real roughness, vec3 n, vec3 l, vec3 v)
{
    vec3 h = brdf_half_vector(l, v);
    real n_l = clamp(vec3_dot(n, l), 0, 1), n_h = clamp(vec3_dot(n, h), 0, 1);
    real v_h = vec3_dot(v, h), share = brdf_specular_share(albedo, n, v);
    real specular = v_h > 0 ? brdf_distribution(brdf_alpha2(roughness), n_h) * n_h / (4 * v_h) : 0;
    return share * specular + (1 - share) * n_l / PI;
}

/* Returns brdf_eval and sets *pdf to brdf_pdf, for half the work of both calls. */
static inline vec3 brdf_eval_pdf(vec3 albedo, real roughness, vec3 n, vec3 l, vec3 v, real *pdf)
{
    vec3 h = brdf_half_vector(l, v);
    real n_l = clamp(vec3_dot(n, l), 0, 1), n_v = clamp(vec3_dot(n, v), 0, 1);
    real n_h = clamp(vec3_dot(n, h), 0, 1), v_h = vec3_dot(v, h);
    real d = brdf_distribution(brdf_alpha2(roughness), n_h), share = brdf_specular_share(albedo, n, v);
    *pdf = share * (v_h > 0 ? d * n_h / (4 * v_h) : 0) + (1 - share) * n_l / PI;
    real s = d * brdf_fresnel(clamp(v_h, 0, 1)) * brdf_visibility(brdf_k(roughness), n_l, n_v);
    return vec3_make(albedo.x / PI + s, albedo.y / PI + s, albedo.z / PI + s);
}

/* Samples l for the unit vector v from a mixture of both lobes; u1, u2 and choice in [0, 1). l may lie below the
 * surface, where its contribution is zero. */
static inline vec3 brdf_sample(vec3 albedo, real roughness, vec3 n, vec3 v, real u1, real u2, real choice)
{
    vec3 h = brdf_sample_half_vector(n, brdf_alpha2(roughness), u1, u2), d = brdf_sample_cosine(n, u1, u2);
    vec3 mirrored = vec3_fma(vec3_scale(v, -1), 2 * vec3_dot(v, h), h);
    bool diffuse = choice >= brdf_specular_share(albedo, n, v);
    return vec3_make(diffuse ? d.x : mirrored.x, diffuse ? d.y : mirrored.y, diffuse ? d.z : mirrored.z);
}

#endif
