/* SPDX-License-Identifier: MIT */
#include "stereo/fit/albedo_scale.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

/* Even colour on the upper half, which is the object; brighter below. */
static void make(int side, const float colour[3], img *albedo, img *mask)
{
    assert_int_equal(img_new(albedo, side, side, 3), OK);
    assert_int_equal(img_new(mask, side, side, 1), OK);
    for (int i = 0; i < side * side; i++) {
        mask->data[i] = i < side * side / 2;
        for (int c = 0; c < 3; c++)
            albedo->data[3 * i + c] = mask->data[i] > 0 ? colour[c] : 5;
    }
}

/* Whatever the size, which decides how many pixels are looked at. */
static void the_brightest_channel_becomes_bright(void **state)
{
    (void)state;
    static const float colours[3][3] = {{0.1f, 0.2f, 0.4f}, {0.1f, 0.4f, 0.2f}, {0.4f, 0.1f, 0.2f}};
    static const int sides[] = {8, 100, 240, 320, 500};
    for (int k = 0; k < 3; k++)
        for (int j = 0; j < 5; j++) {
            img albedo, mask;
            float scale;
            make(sides[j], colours[k], &albedo, &mask);
            assert_int_equal(pst_scale_albedo(&albedo, &mask, &scale), OK);
            assert_float_equal(scale, 2.25, 1e-5);
            for (int c = 0; c < 3; c++)
                assert_float_equal(albedo.data[c], 2.25f * colours[k][c], 1e-5);
            img_free(&albedo);
            img_free(&mask);
        }
}

/* A small object in a large picture is not missed. */
static void a_small_object_is_seen(void **state)
{
    (void)state;
    enum { SIDE = 2000, OBJECT = 10 };
    img albedo, mask;
    float scale;
    assert_int_equal(img_new(&albedo, SIDE, SIDE, 3), OK);
    assert_int_equal(img_new(&mask, SIDE, SIDE, 1), OK);
    for (int y = 0; y < OBJECT; y++)
        for (int x = 0; x < OBJECT; x++) {
            *img_at(&mask, 1001 + x, 701 + y) = 1;
            for (int c = 0; c < 3; c++)
                img_at(&albedo, 1001 + x, 701 + y)[c] = 0.3f;
        }
    assert_int_equal(pst_scale_albedo(&albedo, &mask, &scale), OK);
    assert_float_equal(scale, 3, 1e-5);
    img_free(&albedo);
    img_free(&mask);
}

static void a_few_highlights_and_what_is_no_number_do_not_count(void **state)
{
    (void)state;
    img albedo, mask;
    float scale;
    make(100, (float[3]){0.3f, 0.3f, 0.3f}, &albedo, &mask);
    for (int i = 0; i < 60; i++) /* of 15000 */
        albedo.data[200 * i] = i % 2 ? 40 : NAN;
    assert_int_equal(pst_scale_albedo(&albedo, &mask, &scale), OK);
    assert_float_equal(scale, 3, 1e-5);
    assert_true(albedo.data[0] == 0 && albedo.data[200] == 1);
    img_free(&albedo);
    img_free(&mask);
}

static void a_black_albedo_stays_black(void **state)
{
    (void)state;
    img albedo, mask;
    float scale;
    make(10, (float[3]){0, 0, 0}, &albedo, &mask);
    assert_int_equal(pst_scale_albedo(&albedo, &mask, &scale), OK);
    assert_true(scale == 1 && albedo.data[0] == 0);
    img_free(&albedo);
    img_free(&mask);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_brightest_channel_becomes_bright),
        cmocka_unit_test(a_small_object_is_seen),
        cmocka_unit_test(a_few_highlights_and_what_is_no_number_do_not_count),
        cmocka_unit_test(a_black_albedo_stays_black),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
