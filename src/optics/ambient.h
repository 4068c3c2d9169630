/* SPDX-License-Identifier: MIT */
/* Specular reflection of an environment that is known only by nine spherical harmonic coefficients.
 *
 *     vec3 radiance = ambient_specular(sh, roughness, n, v);
 *
 * The lobe of Karis 2013 (brdf.h) is split as in that paper: the share that it reflects of constant radiance, times the
 * blurred environment's radiance from the mirror direction. It is accurate for smooth environments; nine coefficients
 * do not hold the highlights of lamps and windows. It is used where a network that knows only the coefficients is
 * trained and evaluated; relighting samples the map itself. */
#ifndef MERLIN_OPTICS_AMBIENT_H
#define MERLIN_OPTICS_AMBIENT_H

#include "base/number.h"
#include "optics/brdf.h"
#include "optics/sh.h"

/* Returns the radiance that a matte surface of unit normal n reflects; nine coefficients may be dark somewhere, where
 * it is zero. */
static inline vec3 ambient_diffuse(const real sh[9][3], vec3 albedo, vec3 n)
{
    const vec3 e = sh_irradiance(sh, n);
    return vec3_scale(vec3_mul(albedo, vec3_make(fmax(e.x, 0), fmax(e.y, 0), fmax(e.z, 0))), 1 / PI);
}

/* Returns ∫ specular(l, v) (n·l) dl, what the lobe reflects of radiance 1 from everywhere, for n·v in [0, 1]. It is a
 * least-squares fit in powers of the roughness and of 1 - n·v to quadrature over roughness 0.03 to 1 and n·v 0.02 to 1:
 * within 0.015, root mean square 0.003. */
static inline real ambient_specular_albedo(real roughness, real n_v)
{
    static const double fit[4][5] = {{0.0366, 0.3903, -2.1632, 3.4345, -1.7200},
                                     {0.0869, -1.8957, 9.4999, -13.8846, 6.4971},
                                     {-0.1894, 2.7864, -13.3971, 18.5056, -8.0368},
                                     {0.0811, -1.2784, 6.1022, -8.0774, 3.2691}};
    real u = 1 - n_v, fresnel = (brdf_fresnel(n_v) - BRDF_F0) / (1 - BRDF_F0);
    const real terms[5] = {1, u, u * u, u * u * u, fresnel};
    real r = clamp(roughness, BRDF_MIN_ROUGHNESS, 1), power = 1, sum = 0;
    for (int i = 0; i < 4; i++, power *= r)
        for (int j = 0; j < 5; j++)
            sum += (real)fit[i][j] * power * terms[j];
    return sum > 0 ? sum : 0;
}

/* Returns the factor by which the lobe attenuates the band of coefficient i: a fit to the same quadrature, averaged
 * over n·v; within 0.1. */
static inline real ambient_specular_band(real roughness, int i)
{
    real r = clamp(roughness, BRDF_MIN_ROUGHNESS, 1), r2 = r * r;
    if (i == 0) return 1;
    return i < 4 ? 1 - r2 * ((real)0.6625 - (real)0.1144 * r2) : 1 - r2 * ((real)1.5341 - (real)0.6194 * r2);
}

/* Returns the radiance toward v that the lobe reflects; n and v are unit vectors. */
static inline vec3 ambient_specular(const real sh[9][3], real roughness, vec3 n, vec3 v)
{
    real basis[9], n_v = vec3_dot(n, v);
    sh_basis(vec3_fma(vec3_scale(v, -1), 2 * n_v, n), basis);
    vec3 sum = {0, 0, 0};
    for (int i = 0; i < 9; i++)
        sum = vec3_fma(sum, ambient_specular_band(roughness, i) * basis[i], vec3_make(sh[i][0], sh[i][1], sh[i][2]));
    real albedo = ambient_specular_albedo(roughness, clamp(n_v, 0, 1));
    return vec3_make(albedo * clamp(sum.x, 0, (real)1e6), albedo * clamp(sum.y, 0, (real)1e6),
                     albedo * clamp(sum.z, 0, (real)1e6));
}

#endif
