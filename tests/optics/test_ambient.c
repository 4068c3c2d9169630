/* SPDX-License-Identifier: MIT */
/* The specular lobe in smooth environments, against quadrature. */
#define MERLIN_REAL double
#include "optics/ambient.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { STEPS = 64 };

/* Returns Σ over half vectors sampled by D of f (n·l) radiance / density. */
static vec3 reflected(double roughness, vec3 n, vec3 v, vec3 (*radiance)(vec3))
{
    vec3 sum = {0, 0, 0};
    for (int i = 0; i < STEPS * STEPS; i++) {
        double u1 = (i / STEPS + 0.5) / STEPS, u2 = (i % STEPS + 0.5) / STEPS;
        vec3 h = brdf_sample_half_vector(n, brdf_alpha2(roughness), u1, u2);
        double v_h = vec3_dot(v, h), n_h = vec3_dot(n, h);
        vec3 l = vec3_fma(vec3_scale(v, -1), 2 * v_h, h);
        if (v_h <= 0 || vec3_dot(n, l) <= 0) continue;
        double density = brdf_distribution(brdf_alpha2(roughness), n_h) * n_h / (4 * v_h);
        sum = vec3_fma(sum, brdf_specular(roughness, n, l, v) * vec3_dot(n, l) / density, radiance(l));
    }
    return vec3_scale(sum, 1.0 / (STEPS * STEPS));
}

static vec3 white(vec3 d)
{
    (void)d;
    return vec3_make(1, 1, 1);
}

/* A smooth sky that nine coefficients represent exactly. */
static real sky_sh[9][3];

static vec3 sky(vec3 d)
{
    real basis[9];
    vec3 sum = {0, 0, 0};
    sh_basis(d, basis);
    for (int i = 0; i < 9; i++)
        sum = vec3_fma(sum, basis[i], vec3_make(sky_sh[i][0], sky_sh[i][1], sky_sh[i][2]));
    return sum;
}

static vec3 view_at(double n_v)
{
    return vec3_make(sqrt(1 - n_v * n_v), 0, n_v);
}

static void furnace_share_of_the_lobe_is_the_fit(void **state)
{
    (void)state;
    const vec3 n = {0, 0, 1};
    double square = 0;
    int count = 0;
    for (double r = 0.05; r <= 1; r += 0.095)
        for (double c = 0.05; c <= 1; c += 0.095) {
            double e = ambient_specular_albedo(r, c) - reflected(r, n, view_at(c), white).x;
            assert_true(fabs(e) < 0.016); /* the header's bound, and the error of 64² samples */
            square += e * e;
            count++;
        }
    assert_true(sqrt(square / count) < 0.004);
}

static void smooth_sky_is_reflected_as_by_quadrature(void **state)
{
    (void)state;
    for (int i = 0; i < 27; i++)
        sky_sh[i / 3][i % 3] = i < 3 ? 3.5 : 0.6 * sin(2.3 * i);
    const vec3 n = vec3_normalize(vec3_make(0.3, -0.4, 1));
    for (double r = 0.1; r <= 0.9; r += 0.2)
        for (double c = 0.4; c <= 1; c += 0.2) {
            vec3 v = vec3_normalize(vec3_fma(vec3_scale(n, c), sqrt(1 - c * c), vec3_make(1, 0, -0.3)));
            vec3 expected = reflected(r, n, v, sky);
            vec3 found = ambient_specular((const real(*)[3])sky_sh, r, n, v);
            /* the fit of the share (0.015 at worst) and bands within 0.1 of a sky that varies by a half */
            assert_true(fabs(found.x - expected.x) < 0.02 && fabs(found.z - expected.z) < 0.02);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(furnace_share_of_the_lobe_is_the_fit),
        cmocka_unit_test(smooth_sky_is_reflected_as_by_quadrature),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
