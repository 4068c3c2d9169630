/* SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

#include <math.h>

#include "base/rng.h"
#include "stereo/algebra/matrix3.h"
#include "stereo/fit/normal_spread.h"

enum { LIGHTS = 12, PADDED = 16 };
static const vec3 upright = {0.2f, -0.1f, 0.97f};

/* A matte pixel under a ring of lights about the camera, and the weighted least squares of its values. */
typedef struct pixel {
    float x[PADDED], y[PADDED], z[PADDED], value[PADDED], usable[PADDED], weight[PADDED], model[PADDED];
} pixel;

static vec3 light(const pixel *p, int k)
{
    return vec3_make(p->x[k], p->y[k], p->z[k]);
}

/* Returns albedo times normal without one of the values; -1: with all. */
static vec3 solve(const pixel *p, int without)
{
    float m[6] = {0};
    vec3 right = {0, 0, 0};
    for (int k = 0; k < LIGHTS; k++) {
        if (k == without) continue;
        pst_add_outer3(m, vec3_scale(light(p, k), p->weight[k]), light(p, k));
        right = vec3_fma(right, p->weight[k] * p->value[k], light(p, k));
    }
    return pst_solve3(m, right);
}

static pixel pixel_of(rng *random, float albedo, float noise)
{
    pixel p = {.x = {0}};
    for (int k = 0; k < LIGHTS; k++) {
        const float phi = 6.2831853f * (float)k / LIGHTS, away = k % 2 ? 0.3f : 0.6f;
        p.x[k] = away * cosf(phi);
        p.y[k] = away * sinf(phi);
        p.z[k] = sqrtf(1 - away * away);
        p.value[k] = albedo * vec3_dot(vec3_normalize(upright), light(&p, k)) + noise * rng_normal(random);
        p.usable[k] = 1;
        p.weight[k] = k % 3 ? 1 : 0.5f;
    }
    return p;
}

static float spread_of(pixel *p, vec3 *b)
{
    *b = solve(p, -1);
    for (int k = 0; k < LIGHTS; k++)
        p->model[k] = vec3_dot(*b, light(p, k));
    const pst_observations o = {PADDED, p->x, p->y, p->z, p->value, p->usable, 0};
    return pst_normal_spread(&o, p->weight, p->model, vec3_normalize(*b), vec3_length(*b));
}

/* The closed form is what solving again without each picture gives. */
static void it_is_the_jackknife(void **unused)
{
    (void)unused;
    rng random = rng_at(5, 0, 0);
    for (int trial = 0; trial < 50; trial++) {
        vec3 b;
        pixel p = pixel_of(&random, 0.6f, 0.01f);
        const float spread = spread_of(&p, &b);
        const vec3 n = vec3_normalize(b);
        float sum = 0;
        for (int k = 0; k < LIGHTS; k++) {
            const vec3 change = vec3_sub(solve(&p, k), b), turn = vec3_fma(change, -vec3_dot(n, change), n);
            sum += vec3_dot(turn, turn);
        }
        const float expected = atanf(sqrtf((LIGHTS - 1.0f) / LIGHTS * sum) / vec3_length(b)) * 57.29578f;
        assert_float_equal(spread, expected, 0.01 * (double)expected);
    }
}

/* With noise it is the size of the errors, whatever the albedo. */
static void it_tells_the_size_of_the_errors(void **unused)
{
    (void)unused;
    rng random = rng_at(6, 0, 0);
    double square = 0, off = 0;
    enum { TRIALS = 4000 };
    for (int trial = 0; trial < TRIALS; trial++) {
        vec3 b;
        pixel p = pixel_of(&random, 0.3f, 0.006f);
        const double spread = (double)spread_of(&p, &b), error = vec3_angle(b, upright);
        square += spread * spread / TRIALS;
        off += error * error / TRIALS;
    }
    print_message("spread %.2f degrees, errors %.2f\n", sqrt(square), sqrt(off));
    assert_true(sqrt(square) > 0.95 * sqrt(off) && sqrt(square) < 1.2 * sqrt(off));
}

static void exact_values_have_none(void **unused)
{
    (void)unused;
    rng random = rng_at(7, 0, 0);
    vec3 b;
    pixel p = pixel_of(&random, 0.6f, 0);
    assert_true(spread_of(&p, &b) < 0.01f);
}

static void three_lit_pictures_tell_nothing_of_it(void **unused)
{
    (void)unused;
    rng random = rng_at(8, 0, 0);
    vec3 b;
    pixel p = pixel_of(&random, 0.6f, 0.01f);
    for (int k = 3; k < LIGHTS; k++)
        p.weight[k] = 0;
    assert_true(spread_of(&p, &b) == PST_ANY_NORMAL);
    for (int k = 0; k < LIGHTS; k++)
        p.weight[k] = 0;
    assert_true(spread_of(&p, &b) == PST_ANY_NORMAL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_is_the_jackknife),
        cmocka_unit_test(it_tells_the_size_of_the_errors),
        cmocka_unit_test(exact_values_have_none),
        cmocka_unit_test(three_lit_pictures_tell_nothing_of_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
