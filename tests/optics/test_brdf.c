/* SPDX-License-Identifier: MIT */
/* The BRDF against its own formula, computed elsewhere, and against physics. Compiled in double, so that tolerances
 * measure the formula and not float. */
#define MERLIN_REAL double
#include "optics/brdf.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/rng.h"

static vec3 random_above(rng *r)
{
    double z = 0.001 + 0.999 * rng_uniform(r), phi = 6.283185307 * rng_uniform(r), s = sqrt(1 - z * z);
    return vec3_make(s * cos(phi), s * sin(phi), z);
}

static void assert_close(double value, double expected, double relative)
{
    if (!(fabs(value - expected) <= relative * fmax(fabs(expected), 1e-12)))
        fail_msg("%.12g is not %.12g within %g", value, expected, relative);
}

/* The values of f for normal (0, 0, 1) are from the printed formula by a separate Python script. */
static const struct {
    double albedo, roughness;
    vec3 l, v;
    double f;
} points[10] = {
    {0.425,
     0.10,
     {0.704453716445, 0.268717891836, 0.656913735580},
     {-0.681683707991, -0.259065889026, 0.684245706894},
     4.61678317314},
    {0.290,
     0.20,
     {0.422251163966, -0.805404312749, 0.415966161525},
     {-0.373581133521, 0.828354296062, 0.417452149201},
     1.71283873406},
    {0.639,
     0.30,
     {0.751651010440, 0.406684005649, 0.519258007212},
     {-0.343855886867, 0.893284706098, 0.289491904754},
     0.203622648562},
    {0.428,
     0.40,
     {0.688817960730, -0.504155971258, 0.520918970302},
     {0.597722842985, 0.248856934628, 0.762100799804},
     0.136952527249},
    {0.244,
     0.50,
     {0.738318228895, -0.264537082012, 0.620408192340},
     {-0.854215629140, 0.258774887652, 0.450944804221},
     0.230646303794},
    {0.664,
     0.60,
     {0.934023808196, 0.263347945921, 0.241344950439},
     {-0.840827204229, 0.237393057661, 0.486471118159},
     0.230633075269},
    {0.386,
     0.70,
     {-0.241021957904, 0.900855842658, 0.361063936937},
     {-0.598454865673, -0.793207821959, 0.112574974732},
     0.132509940378},
    {0.449,
     0.85,
     {-0.893468994356, 0.219286998615, 0.391951997524},
     {0.014414001590, 0.961738106118, 0.273591030188},
     0.149575683313},
    {0.233,
     1.00,
     {0.440735246196, -0.566818316627, 0.696038388810},
     {0.839063941997, -0.228231984223, 0.493843965862},
     0.0804809044234},
    {0.780,
     0.03,
     {0.437996146110, -0.894967298550, 0.084811028292},
     {-0.388989031313, 0.917310073841, 0.085028006845},
     0.248399398027},
};

static void brdf_matches_ten_points_computed_by_hand(void **state)
{
    (void)state;
    for (int i = 0; i < 10; i++) {
        vec3 albedo = {points[i].albedo, 0, 1}, n = {0, 0, 1};
        vec3 f = brdf_eval(albedo, points[i].roughness, n, points[i].l, points[i].v);
        /* the directions above are printed to 1e-12 and the lobe is steep: 1e-7; the polynomial 2^x adds 1e-8 */
        assert_close(f.x, points[i].f, 1e-7);
        assert_close(f.x - f.y, points[i].albedo / 3.14159265358979, 1e-9);
    }
}

static void brdf_is_reciprocal(void **state)
{
    (void)state;
    rng r = rng_at(1, 0, 0);
    for (int i = 0; i < 10000; i++) {
        vec3 n = {0, 0, 1}, l = random_above(&r), v = random_above(&r), albedo = {0.2, 0.5, 0.8};
        double roughness = 0.03 + 0.97 * rng_uniform(&r);
        assert_close(brdf_eval(albedo, roughness, n, l, v).y, brdf_eval(albedo, roughness, n, v, l).y, 1e-9);
    }
}

/* Returns ∫ f_s (n·l) dl, with l substituted by half vectors distributed as the lobe is, so that the sharpest one is
 * integrated well. */
static double specular_albedo(double roughness, double cosine)
{
    enum { STEPS = 128 };
    vec3 n = {0, 0, 1}, v = {sqrt(1 - cosine * cosine), 0, cosine};
    double sum = 0, k = brdf_k(roughness);
    for (int i = 0; i < STEPS; i++)
        for (int j = 0; j < STEPS; j++) {
            vec3 h = brdf_sample_half_vector(n, brdf_alpha2(roughness), (i + 0.5) / STEPS, (j + 0.5) / STEPS);
            double v_h = vec3_dot(v, h);
            vec3 l = vec3_fma(vec3_scale(v, -1), 2 * v_h, h);
            if (l.z <= 0 || v_h <= 0) continue;
            sum += brdf_fresnel(v_h) * brdf_visibility(k, l.z, cosine) * l.z * 4 * v_h / h.z;
        }
    return sum / (STEPS * STEPS);
}

static void specular_lobe_never_reflects_more_than_a_white_furnace_sends(void **state)
{
    (void)state;
    for (int i = 0; i <= 20; i++)
        for (int j = 0; j <= 20; j++) {
            double roughness = 0.03 + 0.97 * i / 20, cosine = 0.001 + 0.999 * j / 20;
            double albedo = specular_albedo(roughness, cosine);
            assert_true(albedo > 0 && albedo <= 1);
        }
    /* facing a smooth surface it is Fresnel's F0 times G at n·l = n·v = 1, which is 1; the lobe's width costs 1 % */
    assert_close(specular_albedo(0.03, 1), 0.05 + 0.95 * exp2(-5.55473 - 6.98316), 0.01);
}

/* The header documents it: a white diffuse part is not reduced by the lobe. */
static void white_diffuse_with_the_lobe_exceeds_one(void **state)
{
    (void)state;
    assert_true(1 + specular_albedo(0.5, 0.5) > 1.01);
}

static void brdf_is_finite_everywhere(void **state)
{
    (void)state;
    static const double values[] = {0, 1e-30, 1e-7, 1e-3, 0.03, 0.5, 1};
    for (int i = 0; i < 7; i++)
        for (int j = 0; j < 7; j++)
            for (int k = 0; k < 7; k++) {
                vec3 n = {0, 0, 1}, albedo = {1, 1, 1};
                vec3 l = {sqrt(1 - values[j] * values[j]), 0, values[j]};
                vec3 v = {-sqrt(1 - values[k] * values[k]), 0, values[k]};
                double f = brdf_eval(albedo, values[i], n, l, v).x;
                assert_true(isfinite(f) && f > 0);
                assert_true(isfinite(brdf_pdf(albedo, values[i], n, l, v)));
            }
    vec3 n = {0, 0, 1}, below = {0, 0, -1};
    assert_true(isfinite(brdf_eval(n, 0.5, n, below, n).x));
    assert_true(isfinite(brdf_eval(n, 0.5, n, below, below).x));
}

static void smoother_is_brighter_in_the_mirror_direction_and_darker_beside_it(void **state)
{
    (void)state;
    vec3 n = {0, 0, 1}, black = {0, 0, 0}, beside = {0.6, 0, 0.8};
    for (int i = 0; i < 20; i++) {
        double rough = 0.05 + 0.045 * (i + 1), smooth = 0.05 + 0.045 * i;
        assert_true(brdf_eval(black, smooth, n, n, n).x > brdf_eval(black, rough, n, n, n).x);
    }
    assert_true(brdf_eval(black, 0.05, n, beside, n).x < brdf_eval(black, 0.5, n, beside, n).x);
    /* fully rough: D = 1/π everywhere */
    assert_close(brdf_distribution(brdf_alpha2(1), 0.3), 0.318309886184, 1e-9);
}

/* Compares E[1] over the density's own samples, and E[f cosθ / pdf], with quadrature: samples have the density pdf. */
static void sampling_agrees_with_its_density(void **state)
{
    (void)state;
    rng r = rng_at(2, 0, 0);
    vec3 n = vec3_normalize(vec3_make(0.3, -0.5, 0.4)), v = vec3_normalize(vec3_make(0.5, 0.2, 0.7)),
         grey = {0.5, 0.5, 0.5};
    static const double roughness[] = {0.1, 0.3, 0.8};
    for (int i = 0; i < 3; i++) {
        enum { SAMPLES = 400000 };
        double sum = 0;
        for (int s = 0; s < SAMPLES; s++) {
            double a = rng_uniform(&r), b = rng_uniform(&r), c = rng_uniform(&r);
            vec3 l = brdf_sample(grey, roughness[i], n, v, a, b, c);
            double cosine = vec3_dot(n, l);
            if (cosine <= 0) continue;
            double pdf, f = brdf_eval_pdf(grey, roughness[i], n, l, v, &pdf).x;
            sum += f * cosine / pdf;
            if (s < 100) { /* the same formulas, in another order */
                assert_close(f, brdf_eval(grey, roughness[i], n, l, v).x, 1e-9);
                assert_close(pdf, brdf_pdf(grey, roughness[i], n, l, v), 1e-9);
            }
        }
        double expected = 0.5 + specular_albedo(roughness[i], vec3_dot(n, v));
        /* the estimate's relative deviation is at most about 1/sqrt(400000) = 0.0016; three of those and the grid's */
        assert_close(sum / SAMPLES, expected, 0.006);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(brdf_matches_ten_points_computed_by_hand),
        cmocka_unit_test(brdf_is_reciprocal),
        cmocka_unit_test(specular_lobe_never_reflects_more_than_a_white_furnace_sends),
        cmocka_unit_test(white_diffuse_with_the_lobe_exceeds_one),
        cmocka_unit_test(brdf_is_finite_everywhere),
        cmocka_unit_test(smoother_is_brighter_in_the_mirror_direction_and_darker_beside_it),
        cmocka_unit_test(sampling_agrees_with_its_density),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
