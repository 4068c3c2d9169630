/* SPDX-License-Identifier: MIT */
#include "lab/train/samples/motion.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "lab/train/samples/prepare.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "prepared.h"

static vec3 times(const float m[3][3], vec3 v)
{
    return vec3_make(m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z, m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
                     m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z);
}

/* Tells whether the pixel's neighbours two steps away belong to the object as well. */
static bool is_inside(const train_view *v, int x, int y)
{
    for (int k = 0; k < 25; k++)
        if (v->mask[(y + k / 5 - 2) * SIZE + x + k % 5 - 2] < 0.999f) return false;
    return true;
}

static void turned_camera_sees_the_turned_sphere(void **state)
{
    fixture *f = *state;
    train_config c = {.camera_turn = 8};
    int inside = 0;
    for (uint64_t k = 0; k < 6; k++) {
        rng r = rng_at(4, k, 5);
        train_motion m = train_motion_draw(&c, &r);
        assert_int_equal(train_dataset_get(f->data, 1, 0, &f->view), OK);
        assert_int_equal(train_move(&f->view, &m), OK);
        vec3 centre = times((const float(*)[3])m.turn, vec3_make(0.03f, -0.05f, -1)); /* sample 1 of synthetic.h */
        camera eye = {.width = SIZE, .height = SIZE, .fov = 60};
        for (int y = 2; y < SIZE - 2; y++)
            for (int x = 2; x < SIZE - 2; x++) {
                if (!is_inside(&f->view, x, y)) continue;
                int i = y * SIZE + x;
                vec3 p = camera_point(&eye, (float)x + 0.5f, (float)y + 0.5f, f->view.depth[i]);
                vec3 out = vec3_sub(p, centre), n = vec3_of(f->view.normal + 3 * i);
                /* a pixel is 0.018 wide here; between pixels the sphere of radius 0.32 is at most 0.018²/8/0.32 above
                 * the line, which near the rim is seen ten times as long */
                assert_true(fabsf(vec3_length(out) - 0.32f) < 2e-3f);
                assert_true(vec3_dot(n, vec3_normalize(out)) > 0.999f);
                inside++;
            }
    }
    assert_true(inside > 6 * 300);
}

static float render_error(fixture *f)
{
    float *rendered = malloc(3 * PIXELS * sizeof(float)), error = 0;
    int count = 0;
    assert_non_null(rendered);
    train_render(&f->view, vec3_make(0, 0, 0), rendered);
    for (int y = 2; y < SIZE - 2; y++)
        for (int x = 2; x < SIZE - 2; x++) {
            if (!is_inside(&f->view, x, y)) continue;
            for (int i = 3 * (y * SIZE + x); i < 3 * (y * SIZE + x + 1); i++, count++)
                error += fabsf(rendered[i] - fminf(f->view.direct[i], 1));
        }
    free(rendered);
    return error / (float)count;
}

/* The flash is at the lens, whatever the direction of view: moved maps must render to the moved picture. */
static void moved_maps_render_to_the_moved_picture(void **state)
{
    fixture *f = *state;
    train_config turning = {.camera_turn = 10}, both = {.camera_turn = 10, .distance_jitter = 0.4};
    for (uint64_t k = 0; k < 6; k++) {
        rng r = rng_at(6, k, 5);
        train_motion m = train_motion_draw(k % 2 ? &turning : &both, &r);
        assert_int_equal(train_dataset_get(f->data, (size_t)k % 3, 0, &f->view), OK);
        assert_int_equal(train_move(&f->view, &m), OK);
        /* interpolation, largest where the stripes of albedo meet a highlight; the picture's mean is above 0.5 */
        assert_true(render_error(f) < 0.005f);
    }
}

static void distance_alone_is_exact(void **state)
{
    fixture *f = *state;
    train_motion m = {.distance = 1.5f};
    assert_int_equal(train_dataset_get(f->data, 0, 0, &f->view), OK);
    float depth = f->view.depth[32 * SIZE + 32], indirect = f->view.indirect[3 * (32 * SIZE + 32)];
    assert_int_equal(train_move(&f->view, &m), OK);
    assert_true(render_error(f) < 1e-3f); /* of half floats */
    assert_float_equal(f->view.depth[32 * SIZE + 32], 1.5f * depth, 1e-6f);
    assert_float_equal(f->view.indirect[3 * (32 * SIZE + 32)], indirect / 2.25f, 1e-6f);
}

static void object_that_the_frame_cuts_off_is_not_turned(void **state)
{
    fixture *f = *state;
    train_config c = {.camera_turn = 10};
    rng r = rng_at(6, 0, 5);
    train_motion m = train_motion_draw(&c, &r);
    float depth[PIXELS];
    assert_int_equal(train_dataset_get(f->data, 0, 0, &f->view), OK);
    f->view.mask[5] = 0.3f;
    memcpy(depth, f->view.depth, sizeof depth);
    assert_int_equal(train_move(&f->view, &m), OK);
    assert_memory_equal(depth, f->view.depth, sizeof depth);
}

static void turns_are_rotations_within_their_reach(void **unused)
{
    (void)unused;
    train_config none = {0}, c = {.camera_turn = 10, .distance_jitter = 0.3};
    for (uint64_t k = 0; k < 200; k++) {
        rng r = rng_at(9, k, 5);
        train_motion m = train_motion_draw(&c, &r), still = train_motion_draw(&none, &r);
        assert_false(train_motion_moves(&still));
        assert_true(train_motion_moves(&m));
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) {
                float dot = m.turn[i][0] * m.turn[j][0] + m.turn[i][1] * m.turn[j][1] + m.turn[i][2] * m.turn[j][2];
                assert_float_equal(dot, i == j, 1e-6f);
            }
        /* three rotations of 10 degrees about different axes make one of at most 30 */
        assert_true(m.turn[0][0] + m.turn[1][1] + m.turn[2][2] >= 1 + 2 * cosf(0.524f));
        assert_true(fabsf(logf(m.distance)) <= 0.3f + 1e-6f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(turned_camera_sees_the_turned_sphere, set_up, tear_down),
        cmocka_unit_test_setup_teardown(moved_maps_render_to_the_moved_picture, set_up, tear_down),
        cmocka_unit_test_setup_teardown(distance_alone_is_exact, set_up, tear_down),
        cmocka_unit_test_setup_teardown(object_that_the_frame_cuts_off_is_not_turned, set_up, tear_down),
        cmocka_unit_test(turns_are_rotations_within_their_reach),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
