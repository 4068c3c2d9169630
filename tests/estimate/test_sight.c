/* SPDX-License-Identifier: MIT */
/* What is known of a photograph's lens, and what follows for the maps of its crop. */
#include "estimate/surface/sight.h"

#include <math.h>

#include "estimate/surface/surface.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static void a_whole_photograph_is_as_wide_as_it_is_said_to_be(void **state)
{
    (void)state;
    sight how = sight_of(40, 0, 1000, 1000, (crop_square){0, 0, 1000});
    assert_float_equal(how.lens.fov, 40, 1e-4);
    assert_true(how.lens.slant.right == 0 && how.lens.slant.up == 0);
}

/* 26 mm show 79.5 degrees of a diagonal, and 67.4 of the longer side of 120 x 90; 135 mm show 14.6 of it. */
static void the_focal_length_says_how_wide_a_photograph_is(void **state)
{
    (void)state;
    const crop_square middle = {0, -15, 120};
    assert_float_equal(sight_of(0, 26, 120, 90, middle).lens.fov, 67.3, 0.2);
    assert_float_equal(sight_of(0, 135, 120, 90, middle).lens.fov, 14.6, 0.1);
    assert_float_equal(sight_of(40, 135, 120, 90, middle).lens.fov, 40, 1e-4);
}

/* The crop's pixels lie along the photograph's lines of sight, but for the turn to its middle. */
static void a_crop_sees_what_the_photograph_sees_there(void **state)
{
    (void)state;
    const crop_square crop = {600, 100, 200};
    const camera whole = {.width = 1000, .height = 800, .fov = 60};
    const camera part = camera_through(sight_of(60, 0, 1000, 800, crop).lens, 200, 200);
    for (int i = 0; i < 25; i++) {
        float x = (float)(i % 5 * 50), y = (float)(i / 5 * 50);
        float as_part = vec3_dot(camera_ray(&part, x, y), camera_ray(&part, 30, 170));
        float as_whole = vec3_dot(camera_ray(&whole, 600 + x, 100 + y), camera_ray(&whole, 630, 270));
        assert_float_equal(as_part, as_whole, 2e-6);
    }
}

static void what_cannot_be_is_not_known(void **state)
{
    (void)state;
    const crop_square crop = {0, 0, 100};
    assert_true(sight_of(0, 0, 100, 100, crop).lens.fov == 0);
    assert_true(sight_of(0, 5000, 100, 100, crop).lens.fov == 0);
    assert_true(sight_of(149, 0, 100, 100, crop).lens.fov == 130); /* what is said is not passed over */
    assert_true(sight_of(20, 0, 9000, 9000, crop).lens.fov == 1);
}

/* Under a flash a surface that faced the line of sight that was taken for granted faces the true one. */
static void normals_are_turned_with_the_line_of_sight(void **state)
{
    (void)state;
    enum { SIDE = 32 };
    img normal, mask;
    const camera_lens lens = {15, {0.2f, -0.1f}};
    const camera taken = {.width = SIDE, .height = SIDE, .fov = CAMERA_FOV}, meant = camera_through(lens, SIDE, SIDE);
    assert_int_equal(img_new(&normal, SIDE, SIDE, 3), OK);
    assert_int_equal(img_new(&mask, SIDE, SIDE, 1), OK);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            vec3_put(vec3_scale(camera_ray(&taken, (float)x + 0.5f, (float)y + 0.5f), -1), img_at(&normal, x, y));
            *img_at(&mask, x, y) = 1;
        }
    sight_turn_normals(lens, &mask, &normal);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            vec3 toward = vec3_scale(camera_ray(&meant, (float)x + 0.5f, (float)y + 0.5f), -1);
            assert_true(vec3_length(vec3_sub(toward, vec3_of(img_at(&normal, x, y)))) < 1e-5f);
        }
    img_free(&normal);
    img_free(&mask);
}

static void the_usual_lens_changes_nothing(void **state)
{
    (void)state;
    img normal, mask, depth;
    assert_int_equal(img_new(&normal, 4, 4, 3), OK);
    assert_int_equal(img_new(&mask, 4, 4, 1), OK);
    assert_int_equal(img_new(&depth, 4, 4, 1), OK);
    for (int i = 0; i < 16; i++) {
        vec3_put(vec3_normalize(vec3_make(0.1f * (float)(i % 4), -0.2f, 1)), normal.data + 3 * i);
        mask.data[i] = 1;
        depth.data[i] = 0.8f + 0.02f * (float)i;
    }
    sight_turn_normals((camera_lens){.fov = CAMERA_FOV}, &mask, &normal);
    sight_take_relief((camera_lens){.fov = CAMERA_FOV}, &mask, &depth);
    for (int i = 0; i < 16; i++) {
        vec3 was = vec3_normalize(vec3_make(0.1f * (float)(i % 4), -0.2f, 1));
        assert_true(vec3_length(vec3_sub(was, vec3_of(normal.data + 3 * i))) < 1e-6f);
        assert_float_equal(depth.data[i], 0.8f + 0.02f * (float)i, 1e-6);
    }
    img_free(&normal);
    img_free(&mask);
    img_free(&depth);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_whole_photograph_is_as_wide_as_it_is_said_to_be),
        cmocka_unit_test(the_focal_length_says_how_wide_a_photograph_is),
        cmocka_unit_test(a_crop_sees_what_the_photograph_sees_there),
        cmocka_unit_test(what_cannot_be_is_not_known),
        cmocka_unit_test(normals_are_turned_with_the_line_of_sight),
        cmocka_unit_test(the_usual_lens_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
