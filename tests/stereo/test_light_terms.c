/* SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

#include <math.h>
#include <string.h>

#include "base/rng.h"
#include "stereo/uncalibrated/light_terms.h"

enum { LIGHTS = 5, POINTS = 40 };

static exact3 random3(rng *r, double about, double spread)
{
    const double x = (double)rng_uniform(r), y = (double)rng_uniform(r), z = (double)rng_uniform(r);
    return (exact3){spread * (x - 0.5), spread * (y - 0.5), about + spread * (z - 0.5)};
}

/* Points about the viewing direction, some without anything expected, and lights in front. */
static light_terms make_terms(light_point point[POINTS], vec3 light[LIGHTS], vec3 expected[LIGHTS])
{
    rng r = rng_at(71, 0, 0);
    for (int i = 0; i < POINTS; i++) {
        point[i] = (light_point){
            .b = exact3_normalize(random3(&r, 1, 1.5)), .right = random3(&r, 0, 0.2), .up = random3(&r, 0, 0.2)};
        if (i % 5) point[i].like[LIGHT_OUTLINE] = exact3_normalize(random3(&r, 1, 1.5));
        if (i % 7) point[i].like[LIGHT_EXPECTED] = exact3_normalize(random3(&r, 1, 1.5));
    }
    for (int k = 0; k < LIGHTS; k++) {
        const exact3 a = random3(&r, 1, 1), b = exact3_normalize(random3(&r, 1, 1));
        light[k] = vec3_make((float)a.x, (float)a.y, (float)a.z);
        expected[k] = vec3_scale(vec3_make((float)b.x, (float)b.y, (float)b.z), k == 2 ? 0 : 0.3f + 0.1f * (float)k);
    }
    return (light_terms){.light = light,
                         .expected_light = expected,
                         .count = LIGHTS,
                         .point = point,
                         .points = POINTS,
                         .rough = 0.1,
                         .uneven = 0.02};
}

static const double matrix[9] = {0.9, 0.1, -0.2, 0.15, 1.1, 0.05, 0.1, -0.3, 0.8};

static void test_slopes_are_those_of_finite_differences(void **state)
{
    (void)state;
    light_point point[POINTS];
    vec3 light[LIGHTS], expected[LIGHTS];
    const light_terms t = make_terms(point, light, expected);
    light_equations e;
    assert_true(isfinite(light_terms_cost(&t, matrix, &e)));
    for (int i = 0; i < LIGHT_UNKNOWNS; i++) {
        double low[9], high[9];
        memcpy(low, matrix, sizeof low);
        memcpy(high, matrix, sizeof high);
        low[i] -= 1e-6;
        high[i] += 1e-6;
        const double slope = (light_terms_cost(&t, high, NULL) - light_terms_cost(&t, low, NULL)) / 2e-6;
        assert_true(fabs(-2 * e.right[i] - slope) <= 1e-6 * (1 + fabs(slope)));
    }
}

/* The matrix of one light's strength is the product of slopes, and these squared times the residual are right's. */
static void test_matrix_is_of_the_same_slopes(void **state)
{
    (void)state;
    light_point point[POINTS];
    vec3 light[LIGHTS], expected[LIGHTS];
    light_terms t = make_terms(point, light, expected);
    t.expected_light = NULL;
    t.count = 1;
    t.points = 0;
    light_equations e;
    const double cost = light_terms_cost(&t, matrix, &e);
    for (int i = 0; i < LIGHT_UNKNOWNS; i++)
        for (int j = 0; j <= i; j++) {
            const double product = e.right[i] * e.right[j] / cost;
            assert_true(fabs(e.matrix[LIGHT_UNKNOWNS * i + j] - product) <= 1e-9 * (1 + fabs(product)));
        }
}

static void test_matrix_without_inverse_has_no_cost(void **state)
{
    (void)state;
    light_point point[POINTS];
    vec3 light[LIGHTS], expected[LIGHTS];
    const light_terms t = make_terms(point, light, expected);
    const double flat[9] = {1, 0, 0, 0, 1, 0, 0, 0, 0};
    assert_true(isinf(light_terms_cost(&t, flat, NULL)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_slopes_are_those_of_finite_differences),
        cmocka_unit_test(test_matrix_is_of_the_same_slopes),
        cmocka_unit_test(test_matrix_without_inverse_has_no_cost),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
