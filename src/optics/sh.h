/* SPDX-License-Identifier: MIT */
/* Real spherical harmonics of bands 0 to 2, order L00, L1-1, L10, L11, L2-2, L2-1, L20, L21, L22.
 *
 *     real sh[9][3] = {0};
 *     for (every texel) sh_accumulate(sh, direction, radiance times solid angle);
 *     vec3 e = sh_irradiance(sh, normal);
 *
 * Irradiance as in Ramamoorthi & Hanrahan 2001: the clamped cosine scales the three bands by π, 2π/3 and π/4. */
#ifndef MERLIN_OPTICS_SH_H
#define MERLIN_OPTICS_SH_H

#include "base/vec.h"

/* Evaluates the nine basis functions at the unit direction d. */
static inline void sh_basis(vec3 d, real out[9])
{
    out[0] = (real)0.28209479177387814;
    out[1] = (real)0.48860251190291992 * d.y;
    out[2] = (real)0.48860251190291992 * d.z;
    out[3] = (real)0.48860251190291992 * d.x;
    out[4] = (real)1.0925484305920792 * d.x * d.y;
    out[5] = (real)1.0925484305920792 * d.y * d.z;
    out[6] = (real)0.31539156525252005 * (3 * d.z * d.z - 1);
    out[7] = (real)1.0925484305920792 * d.x * d.z;
    out[8] = (real)0.54627421529603959 * (d.x * d.x - d.y * d.y);
}

/* Adds one direction's radiance times its solid angle (per channel) to the coefficients. */
static inline void sh_accumulate(real sh[9][3], vec3 d, vec3 weighted_radiance)
{
    real basis[9];
    sh_basis(d, basis);
    for (int i = 0; i < 9; i++) {
        sh[i][0] += basis[i] * weighted_radiance.x;
        sh[i][1] += basis[i] * weighted_radiance.y;
        sh[i][2] += basis[i] * weighted_radiance.z;
    }
}

/* Returns the clamped cosine's factor for the band of coefficient i. */
static inline real sh_cosine_band(int i)
{
    return i == 0 ? (real)3.14159265358979324 : i < 4 ? (real)2.09439510239319549 : (real)0.78539816339744831;
}

/* Returns the irradiance on a surface of unit normal n; a Lambertian surface reflects albedo/π of it. */
static inline vec3 sh_irradiance(const real sh[9][3], vec3 n)
{
    real basis[9];
    sh_basis(n, basis);
    vec3 e = {0, 0, 0};
    for (int i = 0; i < 9; i++)
        e = vec3_fma(e, sh_cosine_band(i) * basis[i], vec3_make(sh[i][0], sh[i][1], sh[i][2]));
    return e;
}

/* Returns the gradient of weight · sh_irradiance(sh, n) by n, whose components count as three independent numbers. */
static inline vec3 sh_irradiance_gradient(const real sh[9][3], vec3 n, vec3 weight)
{
    real s[9];
    for (int i = 0; i < 9; i++)
        s[i] = sh_cosine_band(i) * vec3_dot(weight, vec3_make(sh[i][0], sh[i][1], sh[i][2]));
    const real first = (real)0.48860251190291992, second = (real)1.0925484305920792;
    return vec3_make(first * s[3] + second * (s[4] * n.y + s[7] * n.z + s[8] * n.x),
                     first * s[1] + second * (s[4] * n.x + s[5] * n.z - s[8] * n.y),
                     first * s[2] + second * (s[5] * n.y + s[7] * n.x) + (real)1.8923493915151202 * s[6] * n.z);
}

/* Holds coefficients to what light can have that is negative nowhere: in band l they are no longer than √(2l + 1) L00,
 * which all light from one direction has, by the addition theorem. */
static inline void sh_hold_positive(real sh[9][3])
{
    const real longest[3] = {1, (real)1.7320508075688772, (real)2.2360679774997898};
    for (int c = 0; c < 3; c++) {
        if (!(sh[0][c] > 0)) sh[0][c] = 0;
        for (int band = 1; band < 3; band++) {
            const int first = band * band, last = first + 2 * band;
            real square = 0, most = longest[band] * sh[0][c];
            for (int i = first; i <= last; i++)
                square += sh[i][c] * sh[i][c];
            if (!(square > most * most)) continue;
            for (int i = first; i <= last; i++)
                sh[i][c] *= most / sqrt(square);
        }
    }
}

/* Convert one channel's band 2 to the symmetric matrix q of dᵀ q d, and back. */
static inline void sh_band2_matrix(const real sh[9][3], int channel, real q[3][3])
{
    const real pair = (real)0.5462742152960396, squares = (real)0.54627421529603959, polar = (real)0.31539156525252005;
    q[0][0] = squares * sh[8][channel] - polar * sh[6][channel];
    q[1][1] = -squares * sh[8][channel] - polar * sh[6][channel];
    q[2][2] = 2 * polar * sh[6][channel];
    q[0][1] = q[1][0] = pair * sh[4][channel];
    q[1][2] = q[2][1] = pair * sh[5][channel];
    q[0][2] = q[2][0] = pair * sh[7][channel];
}

static inline void sh_band2_from_matrix(real q[3][3], int channel, real sh[9][3])
{
    const real pair = (real)0.5462742152960396, polar = (real)0.31539156525252005;
    sh[4][channel] = q[0][1] / pair;
    sh[5][channel] = q[1][2] / pair;
    sh[6][channel] = q[2][2] / (2 * polar);
    sh[7][channel] = q[0][2] / pair;
    sh[8][channel] = (q[0][0] - q[1][1]) / (2 * pair);
}

/* Turns the environment by the orthogonal matrix m (rotation, reflection or both): light from d then comes from m d. */
static inline void sh_turn(real sh[9][3], const real m[3][3])
{
    for (int c = 0; c < 3; c++) {
        const real line[3] = {sh[3][c], sh[1][c], sh[2][c]};
        real q[3][3], turned[3] = {0, 0, 0}, both[3][3] = {{0}};
        sh_band2_matrix((const real(*)[3])sh, c, q);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) {
                turned[i] += m[i][j] * line[j];
                for (int k = 0; k < 9; k++)
                    both[i][j] += m[i][k / 3] * q[k / 3][k % 3] * m[j][k % 3];
            }
        sh[3][c] = turned[0];
        sh[1][c] = turned[1];
        sh[2][c] = turned[2];
        sh_band2_from_matrix(both, c, sh);
    }
}

#endif
