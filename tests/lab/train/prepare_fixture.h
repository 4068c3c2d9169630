/* SPDX-License-Identifier: MIT */
/* Samples for the tests of their preparation. */
#ifndef MERLIN_TESTS_TRAIN_PREPARE_FIXTURE_H
#define MERLIN_TESTS_TRAIN_PREPARE_FIXTURE_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "lab/train/samples/dataset.h"
#include "lab/train/samples/prepare.h"
#include "optics/orientation.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "prepared.h"

/* The training of earlier runs must not change. */
static inline void photographs_have_no_faults_unless_asked_for(void **unused)
{
    (void)unused;
    train_config none = {0}, all = {.background_leak = 1, .outline_error = 1, .jpeg = 1};
    for (uint64_t i = 0; i < 100; i++) {
        train_camera lens = train_camera_perfect();
        rng r = rng_at(1, i, 3);
        train_camera_degrade(&none, &r, &lens);
        assert_false(lens.background || lens.outline || lens.jpeg);
        train_camera_degrade(&all, &r, &lens);
        assert_true(lens.background && abs(lens.outline) == 1 && lens.jpeg);
    }
}

/* Photographs as in the paper skip the random numbers of exposure, noise and white, too. */
static inline void perfect_cameras_are_as_many_as_asked_for(void **unused)
{
    (void)unused;
    enum { DRAWS = 2000 };
    train_config half = {.exposure_jitter = 0.3, .colour_jitter = 0.1, .background_leak = 1, .perfect_camera = 0.5};
    train_camera perfect = train_camera_perfect();
    int count = 0;
    for (uint64_t i = 0; i < DRAWS; i++) {
        rng r = rng_at(1, i, 3);
        train_camera lens = train_camera_draw(&half, &r);
        train_camera_degrade(&half, &r, &lens);
        bool is_perfect = memcmp(lens.gain, perfect.gain, sizeof lens.gain) == 0 && lens.white == perfect.white;
        assert_true(is_perfect != lens.background);
        count += is_perfect;
    }
    /* five standard deviations of a binomial count */
    assert_in_range(count, DRAWS / 2 - 112, DRAWS / 2 + 112);
}

static inline void target_lights_lie_on_the_frontal_hemisphere(void **unused)
{
    (void)unused;
    rng r = rng_at(5, 6, 7);
    for (int i = 0; i < 1000; i++) {
        vec3 light = train_draw_light(&r);
        assert_float_equal(vec3_length(vec3_sub(light, vec3_make(0, 0, -1))), 1, 1e-5);
        assert_true(light.z >= -1);
    }
}

static inline vec3 random_direction(rng *r)
{
    float z = rng_range(r, -1, 1), phi = rng_range(r, 0, 6.2831853f), s = sqrtf(1 - z * z);
    return vec3_make(s * cosf(phi), s * sinf(phi), z);
}

/* Turns a direction as train_dataset_get turns normals; rows run downwards, y upwards. */
static inline vec3 turned(int orientation, vec3 d)
{
    if (orientation & ORIENTATION_FLIP_X) d.x = -d.x;
    if (orientation & ORIENTATION_FLIP_Y) d.y = -d.y;
    return orientation & ORIENTATION_TRANSPOSE ? vec3_make(-d.y, -d.x, d.z) : d;
}

static inline void turned_sky_in_a_turned_direction_is_the_sky(void **unused)
{
    (void)unused;
    rng r = rng_at(3, 1, 4);
    for (int orientation = 0; orientation < ORIENTATIONS; orientation++) {
        float before[9][3], after[9][3];
        sphere_sky(1, before);
        sphere_sky(1, after);
        orientation_turn_sh(orientation, after);
        for (int i = 0; i < 50; i++) {
            vec3 d = random_direction(&r);
            vec3 a = sh_irradiance((const float(*)[3])before, d);
            vec3 b = sh_irradiance((const float(*)[3])after, turned(orientation, d));
            assert_float_equal(a.x, b.x, 1e-5); /* nine float terms of size 1 in another order */
            assert_float_equal(a.z, b.z, 1e-5);
        }
    }
}

static inline void strengths_span_a_decade(void **unused)
{
    (void)unused;
    rng r = rng_at(5, 6, 7);
    int weak = 0;
    for (int i = 0; i < 1000; i++) {
        float s = train_draw_strength(&r);
        assert_true(s >= 0.099f && s <= 1.001f);
        weak += s < 0.316f;
    }
    assert_in_range(weak, 400, 600); /* half of them, standard deviation 16 */
}

static inline void a_share_of_targets_is_dark(void **unused)
{
    (void)unused;
    rng r = rng_at(5, 6, 7);
    int dark = 0;
    for (int i = 0; i < 1000; i++) {
        float s = train_draw_target_strength(0.25f, &r);
        assert_true(s == 0 || (s >= 0.099f && s <= 1.001f));
        dark += s == 0;
        assert_true(train_draw_target_strength(0, &r) > 0);
    }
    assert_in_range(dark, 200, 300); /* standard deviation 14 */
}

#endif
