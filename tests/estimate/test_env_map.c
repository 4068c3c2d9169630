/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "estimate/light/env_map.h"
#include "estimate/relight/relighter.h"
#include "image/exr/exr.h"
#include "image/image.h"
#include "merlin/merlin.h"
#include "optics/latlong.h"
#include "optics/sh.h"
#include "scratch.h"
#include "surroundings.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static env_map map_of(vec3 (*radiance)(vec3))
{
    env_map e;
    assert_int_equal(surroundings(radiance, 256, &e), OK);
    return e;
}

static vec3 even(vec3 d)
{
    (void)d;
    return vec3_make(0.5f, 1, 2);
}

/* Bands 0 to 2 only. */
static vec3 smooth(vec3 d)
{
    return vec3_make(1 + 0.5f * d.x, 1 + 0.5f * d.y, 1 - 0.4f * d.z + 0.3f * d.x * d.y);
}

static vec3 spot_ahead(vec3 d)
{
    return d.z < -0.995f ? vec3_make(100, 100, 100) : vec3_make(0, 0, 0);
}

/* Spread over the sphere, the seams of the octahedron (the planes x = 0, y = 0 and z = 0) among them. */
static vec3 direction(int i)
{
    static const vec3 seams[] = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, 1, 0}, {0.6f, 0.8f, 0}, {-0.6f, -0.8f, 0}};
    if (i < 6) return seams[i];
    float z = 1 - 2 * ((float)(i - 6) + 0.5f) / 100, phi = 2.39996f * (float)i, s = sqrtf(1 - z * z);
    return vec3_make(s * cosf(phi), s * sinf(phi), z);
}
enum { DIRECTIONS = 106 };

static void even_surroundings_are_even_at_every_level(void **state)
{
    (void)state;
    env_map e = map_of(even);
    for (int i = 0; i < DIRECTIONS; i++)
        for (float angle = 1e-6f; angle < 12; angle *= 5) {
            vec3 c = env_map_lookup(&e, direction(i), angle);
            assert_float_equal(c.x, 0.5f, 1e-5);
            assert_float_equal(c.z, 2, 1e-5);
        }
    env_map_free(&e);
}

static void sharp_look_up_is_the_map(void **state)
{
    (void)state;
    env_map e = map_of(smooth);
    for (int i = 0; i < DIRECTIONS; i++) {
        vec3 c = env_map_lookup(&e, direction(i), 0), expected = smooth(direction(i));
        assert_float_equal(c.x, expected.x,
                           0.02); /* a texel is 1.4 degrees wide: 0.5 × half of that, and a cell more */
        assert_float_equal(c.y, expected.y, 0.02);
        assert_float_equal(c.z, expected.z, 0.02);
    }
    env_map_free(&e);
}

static void blurred_look_up_keeps_the_light_of_a_lamp(void **state)
{
    (void)state;
    env_map e = map_of(spot_ahead);
    double sharp = 0, blurred = 0;
    enum { STEPS = 400 };
    for (int i = 0; i < STEPS; i++)
        for (int k = 0; k < STEPS; k++) {
            float z = 1 - 2 * ((float)i + 0.5f) / STEPS, phi = 6.2831853f * ((float)k + 0.5f) / STEPS;
            vec3 d = vec3_make(sqrtf(1 - z * z) * cosf(phi), sqrtf(1 - z * z) * sinf(phi), z);
            sharp += (double)env_map_lookup(&e, d, 0).y;
            blurred += (double)env_map_lookup(&e, d, 0.05f).y;
        }
    double mean = 100 * 0.005 / 2; /* radiance times the share of the sphere: (1 - 0.995) / 2 */
    assert_float_equal(sharp / (STEPS * STEPS), mean, 0.05 * mean); /* the spot's edge runs through texels */
    assert_float_equal(blurred / (STEPS * STEPS), mean, 0.05 * mean);
    assert_float_equal((double)env_map_mean(&e), mean, 0.05 * mean);
    assert_true(env_map_lookup(&e, vec3_make(0, 0, -1), 1).y < 10);
    env_map_free(&e);
}

static void what_was_ahead_is_to_the_right_after_a_quarter_turn(void **state)
{
    (void)state;
    env_map e = map_of(spot_ahead);
    const vec3 ahead = {0, 0, -1}, right = {1, 0, 0}, behind = {0, 0, 1};
    assert_true(env_map_lookup(&e, ahead, 0).y > 90);
    env_map_turn(&e, 90);
    assert_true(env_map_lookup(&e, right, 0).y > 90 && env_map_lookup(&e, ahead, 0).y < 1);
    vec3 by_right = sh_irradiance((const float(*)[3])e.sh, right),
         by_ahead = sh_irradiance((const float(*)[3])e.sh, ahead);
    assert_true(by_right.y > 4 * by_ahead.y);
    env_map_turn(&e, 90);
    assert_true(env_map_lookup(&e, behind, 0).y > 90);
    env_map_free(&e);
}

static void coefficients_are_those_of_the_map(void **state)
{
    (void)state;
    env_map e = map_of(smooth);
    for (int turn = 0; turn < 2; turn++) {
        /* smooth()'s red at 90 degrees: what pointed ahead, -z, points to +x; so +x points behind, +z */
        vec3 n = vec3_normalize(vec3_make(0.5f, -0.3f, 0.7f));
        vec3 irradiance = sh_irradiance((const float(*)[3])e.sh, n);
        float slope = turn ? n.z : n.x;
        /* band 1 keeps 2π/3 of the radiance's slope */
        assert_float_equal(irradiance.x, 3.14159f * (1 + 0.5f * slope * 2 / 3), 0.005);
        env_map_turn(&e, 90);
    }
    env_map_free(&e);
}

static void impossible_radiance_counts_as_black(void **state)
{
    (void)state;
    img latlong = {0};
    env_map e;
    assert_int_equal(img_new(&latlong, 16, 8, 3), OK);
    for (int i = 0; i < 16 * 8 * 3; i++)
        latlong.data[i] = i % 4 == 0 ? NAN : i % 4 == 1 ? -1 : i % 4 == 2 ? INFINITY : 1;
    assert_int_equal(env_map_new(&latlong, &e), OK);
    for (int i = 0; i < DIRECTIONS; i++) {
        vec3 c = env_map_lookup(&e, direction(i), 0.01f);
        assert_true(c.x >= 0 && c.x <= 1 && c.y >= 0 && c.y <= 1);
    }
    assert_true(isfinite(e.sh[3][1]));
    env_map_free(&e);
    img_free(&latlong);
}

/* Every pixel of a map as four of a wider one, one of them impossible and the others more by a third. */
static void a_map_wider_than_is_resolved_is_its_means(void **state)
{
    (void)state;
    enum { WIDTH = 1024, HEIGHT = WIDTH / 2 };
    img narrow = {0}, wide = {0};
    env_map a, b;
    assert_int_equal(img_new(&narrow, WIDTH, HEIGHT, 3), OK);
    assert_int_equal(img_new(&wide, 2 * WIDTH, 2 * HEIGHT, 3), OK);
    for (int y = 0; y < 2 * HEIGHT; y++)
        for (int x = 0; x < 2 * WIDTH; x++)
            for (int c = 0; c < 3; c++) {
                float value = 1 + (float)((x / 2 * 7 + y / 2 * 3 + c) % 10);
                img_at(&narrow, x / 2, y / 2)[c] = value;
                img_at(&wide, x, y)[c] = x % 2 && y % 2 ? INFINITY : value * 4 / 3;
            }
    assert_int_equal(env_map_new(&narrow, &a), OK);
    assert_int_equal(env_map_new(&wide, &b), OK);
    for (int i = 0; i < DIRECTIONS; i++)
        assert_float_equal(env_map_lookup(&a, direction(i), 0).x, env_map_lookup(&b, direction(i), 0).x, 1e-4);
    for (int i = 0; i < 27; i++)
        assert_float_equal(a.sh[i / 3][i % 3], b.sh[i / 3][i % 3], 1e-4);
    env_map_free(&a);
    env_map_free(&b);
    img_free(&narrow);
    img_free(&wide);
}

static void negative_values_of_a_file_are_counted(void **state)
{
    (void)state;
    enum { VALUES = 3 * 32 * 16 };
    float values[VALUES];
    merlin_environment *room;
    for (int i = 0; i < VALUES; i++)
        values[i] = i < 2 ? -3 : i < 10 ? -1e-5f : 1; /* the latter is what enlarging leaves */
    const exr_channel channels[] = {{"R", values, 3, true}, {"G", values + 1, 3, true}, {"B", values + 2, 3, true}};
    const char *path = scratch_path("negative.exr");
    assert_int_equal(exr_write(path, 32, 16, channels, 3, NULL, 0), OK);
    assert_int_equal(merlin_environment_read(path, 0, 0, &room), MERLIN_OK);
    assert_float_equal(room->negative, 2.0 / VALUES, 1e-9);
    merlin_environment_free(room);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(even_surroundings_are_even_at_every_level),
        cmocka_unit_test(sharp_look_up_is_the_map),
        cmocka_unit_test(blurred_look_up_keeps_the_light_of_a_lamp),
        cmocka_unit_test(what_was_ahead_is_to_the_right_after_a_quarter_turn),
        cmocka_unit_test(coefficients_are_those_of_the_map),
        cmocka_unit_test(impossible_radiance_counts_as_black),
        in_scratch(negative_values_of_a_file_are_counted),
        cmocka_unit_test(a_map_wider_than_is_resolved_is_its_means),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
