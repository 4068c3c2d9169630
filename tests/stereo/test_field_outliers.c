/* SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

#include "base/rng.h"
#include "relief.h"
#include "stereo/fit/field_fit.h"

enum { SIZE = 24, LIGHTS = 48, CREASE = 16, GROOVE = 7 };

static const pst_lobe matte = {.width = 0.04f, .shadow = PST_SHADOW_COST, .masking = 0.28f};

/* Two roofs that meet in a crease; in one of them a groove one pixel wide. */
static vec3 roof_normal(int x)
{
    float tilt = x == GROOVE ? 0.5f : x < CREASE ? -0.5f : 0.7f;
    return vec3_make(sinf(tilt), 0, cosf(tilt));
}

typedef struct roof {
    merlin_capture capture;
    pst_problem problem;
    pst_field field;
} roof;

/* Fitted; values are off by up to 6 percent, so that every fit costs something. */
static void roof_new(roof *r)
{
    double cost;
    rng random = rng_at(5, 0, 0);
    capture_new(&r->capture, SIZE, LIGHTS, 1);
    relief matte_relief = {.exposure = 1};
    for (int k = 0; k < LIGHTS; k++) {
        vec3 l = relief_light(k, LIGHTS);
        vec3_put(l, r->capture.light[k].direction);
        for (int i = 0; i < SIZE * SIZE; i++) {
            float value = relief_radiance(&matte_relief, 0.8f, roof_normal(i % SIZE), l);
            r->capture.picture[k].wide[i] = relief_code(value * (0.94f + 0.12f * rng_uniform(&random)));
        }
    }
    for (int i = 0; i < SIZE * SIZE; i++)
        r->capture.mask.data[i] = 1;
    r->problem = (pst_problem){.capture = &r->capture, .light = r->capture.light, .saturation = PST_SATURATED};
    assert_int_equal(pst_list_pixels(&r->capture, &r->problem), OK);
    r->field = (pst_field){.problem = &r->problem,
                           .pixel = r->problem.pixel,
                           .count = r->problem.pixel_count,
                           .lobe = &matte,
                           .shading = calloc(SIZE * SIZE, sizeof(pst_shading))};
    assert_int_equal(pst_field_fit(&r->field, &cost), OK);
}

static void roof_drop(roof *r)
{
    free(r->field.shading);
    free(r->problem.pixel);
    capture_drop(&r->capture);
}

/* 2 degrees: four times what values off by 3 percent (in the mean square) turn a normal by under 48 lights. */
static void assert_right(const roof *r)
{
    for (int i = 0; i < SIZE * SIZE; i++)
        assert_true(vec3_dot(r->field.shading[i].normal, roof_normal(i % SIZE)) > 0.9994f);
}

/* As where a wrong surface costs less than the right one: two pixels side by side and one at the border, turned. */
static void speckles_are_fitted_again_from_the_majority(void **state)
{
    (void)state;
    static const int speckle[] = {10 * SIZE + 11, 10 * SIZE + 12, 15 * SIZE + SIZE - 1};
    roof r;
    roof_new(&r);
    assert_right(&r);
    for (size_t k = 0; k < sizeof speckle / sizeof *speckle; k++) {
        pst_shading *one = &r.field.shading[speckle[k]];
        one->normal = vec3_make(0, 0.8f, 0.6f);
        one->cost *= 0.7f;
    }
    assert_int_equal(pst_field_replace_outliers(&r.field, 2), OK);
    assert_right(&r);
    roof_drop(&r);
}

/* The groove's pixels stand against six of their eight neighbours, but cost far more as these have it. */
static void creases_and_grooves_a_pixel_wide_stay(void **state)
{
    (void)state;
    roof r;
    roof_new(&r);
    assert_int_equal(pst_field_replace_outliers(&r.field, 2), OK);
    assert_right(&r);
    roof_drop(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(speckles_are_fitted_again_from_the_majority),
        cmocka_unit_test(creases_and_grooves_a_pixel_wide_stay),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
