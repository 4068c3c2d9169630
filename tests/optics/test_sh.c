/* SPDX-License-Identifier: MIT */
/* Spherical harmonics against quadrature over the sphere. */
#define MERLIN_REAL double
#include "optics/sh.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

enum { POLAR = 400, AROUND = 800 };
static const double pi = 3.14159265358979324;

/* Returns the directions of the midpoint rule in cosθ and φ. Its error is h²/24 (f'(1) − f'(−1)) · 2π with h = 2/POLAR:
 * 3e-5 for the steepest product, that of L20 with itself. */
static vec3 direction(int i, int j)
{
    double z = 1 - 2 * (i + 0.5) / POLAR, phi = 2 * pi * (j + 0.5) / AROUND, s = sqrt(1 - z * z);
    return vec3_make(s * cos(phi), s * sin(phi), z);
}
static const double solid_angle = 4 * 3.14159265358979324 / (POLAR * AROUND);

static void basis_is_orthonormal(void **state)
{
    (void)state;
    double product[9][9] = {{0}};
    for (int i = 0; i < POLAR; i++)
        for (int j = 0; j < AROUND; j++) {
            double y[9];
            sh_basis(direction(i, j), y);
            for (int a = 0; a < 9; a++)
                for (int b = 0; b < 9; b++)
                    product[a][b] += y[a] * y[b] * solid_angle;
        }
    for (int a = 0; a < 9; a++)
        for (int b = 0; b < 9; b++)
            assert_true(fabs(product[a][b] - (a == b)) < 4e-5);
}

/* Returns a sky of bands 0 to 2 only, which nine coefficients represent exactly. */
static vec3 sky(vec3 d)
{
    return vec3_make(1 + 0.5 * d.y, 0.7 + 0.3 * d.x * d.z, 0.4 + 0.2 * d.z * d.z - 0.1 * d.x);
}

static void irradiance_from_coefficients_matches_quadrature(void **state)
{
    (void)state;
    real sh[9][3] = {{0}};
    for (int i = 0; i < POLAR; i++)
        for (int j = 0; j < AROUND; j++) {
            vec3 d = direction(i, j);
            sh_accumulate(sh, d, vec3_scale(sky(d), solid_angle));
        }
    static const vec3 normals[] = {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}, {0.48, -0.6, 0.64}, {-0.6, 0, -0.8}};
    for (int n = 0; n < 5; n++) {
        vec3 expected = {0, 0, 0};
        for (int i = 0; i < POLAR; i++)
            for (int j = 0; j < AROUND; j++) {
                vec3 d = direction(i, j);
                expected = vec3_fma(expected, fmax(0, vec3_dot(normals[n], d)) * solid_angle, sky(d));
            }
        vec3 e = sh_irradiance((const real(*)[3])sh, normals[n]);
        /* the clamp's kink costs the quadrature a little more */
        assert_true(vec3_length(vec3_sub(e, expected)) < 2e-4);
    }
}

static void constant_radiance_gives_pi_irradiance(void **state)
{
    (void)state;
    real sh[9][3] = {{0}};
    for (int c = 0; c < 3; c++)
        sh[0][c] = 2 * sqrt(pi);
    vec3 e = sh_irradiance((const real(*)[3])sh, vec3_make(0, 0.6, 0.8));
    assert_true(fabs(e.x - pi) < 1e-12 && fabs(e.z - pi) < 1e-12);
}

static void gradient_is_that_of_central_differences(void **state)
{
    (void)state;
    real sh[9][3];
    for (int i = 0; i < 27; i++)
        sh[i / 3][i % 3] = sin(3.7 * i + 1);
    const real(*c)[3] = (const real(*)[3])sh;
    const vec3 n = {0.48, -0.6, 0.64}, weight = {0.7, -0.2, 1.1}, axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    vec3 g = sh_irradiance_gradient(c, n, weight);
    const double found[3] = {g.x, g.y, g.z}, h = 1e-4;
    for (int k = 0; k < 3; k++) {
        double up = vec3_dot(weight, sh_irradiance(c, vec3_fma(n, h, axes[k])));
        double down = vec3_dot(weight, sh_irradiance(c, vec3_fma(n, -h, axes[k])));
        /* irradiance is a quadratic in n, for which central differences are exact except for rounding, 1e-16 / 1e-4 */
        assert_true(fabs(found[k] - (up - down) / (2 * h)) < 1e-10);
    }
}

static void turned_environment_in_a_turned_direction_is_the_environment(void **state)
{
    (void)state;
    /* a rotation about an axis without symmetry, and the same with a reflection */
    const vec3 x = vec3_normalize(vec3_make(0.6, -0.5, 0.3)), y = vec3_normalize(vec3_cross(x, vec3_make(0, 0, 1)));
    const vec3 z = vec3_cross(x, y);
    for (int mirrored = 0; mirrored < 2; mirrored++) {
        double sign = mirrored ? -1 : 1, before[9][3], after[9][3];
        const real m[3][3] = {{x.x, x.y, x.z}, {y.x, y.y, y.z}, {sign * z.x, sign * z.y, sign * z.z}};
        for (int i = 0; i < 27; i++)
            before[i / 3][i % 3] = after[i / 3][i % 3] = sin(1.9 * i + 2);
        sh_turn(after, m);
        for (int i = 0; i < 20; i++) {
            vec3 d = direction(20 * i + 3, 37 * i);
            vec3 turned = vec3_make(vec3_dot(x, d), vec3_dot(y, d), sign * vec3_dot(z, d));
            vec3 a = sh_irradiance((const real(*)[3])before, d), b = sh_irradiance((const real(*)[3])after, turned);
            assert_true(vec3_length(vec3_sub(a, b)) < 1e-9);
        }
    }
}

static double band_length(double sh[9][3], int band)
{
    double square = 0;
    for (int i = band * band; i < (band + 1) * (band + 1); i++)
        square += sh[i][1] * sh[i][1];
    return sqrt(square);
}

/* Light from one direction is the limit of what is light, and stays as it is; what is none is held to it. */
static void coefficients_are_held_to_those_of_light(void **state)
{
    (void)state;
    double one[9][3] = {{0}}, same[9][3], dark[9][3], long_bands[9][3];
    sh_accumulate(one, direction(7, 31), vec3_make(1, 2, 3));
    memcpy(same, one, sizeof same);
    sh_hold_positive(same);
    for (int i = 0; i < 27; i++) {
        assert_true(fabs(same[i / 3][i % 3] - one[i / 3][i % 3]) < 1e-12);
        dark[i / 3][i % 3] = i < 3 ? -0.1 : 1;
        long_bands[i / 3][i % 3] = i < 3 ? 1 : 10;
    }
    sh_hold_positive(dark);
    sh_hold_positive(long_bands);
    for (int i = 0; i < 27; i++)
        assert_true(dark[i / 3][i % 3] == 0);
    assert_true(long_bands[0][1] == 1);
    assert_true(fabs(band_length(long_bands, 1) - sqrt(3)) < 1e-12);
    assert_true(fabs(band_length(long_bands, 2) - sqrt(5)) < 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(basis_is_orthonormal),
        cmocka_unit_test(irradiance_from_coefficients_matches_quadrature),
        cmocka_unit_test(constant_radiance_gives_pi_irradiance),
        cmocka_unit_test(gradient_is_that_of_central_differences),
        cmocka_unit_test(turned_environment_in_a_turned_direction_is_the_environment),
        cmocka_unit_test(coefficients_are_held_to_those_of_light),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
