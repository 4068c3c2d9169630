/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include "base/status.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

#include "stereo/capture/frame_choice.h"

enum { SIDE = 48, MOST = 8 };

/* Adds a frame of a disc that is lit from this angle, as strongly as stated, with noise. */
static void add(frame_looks *looks, double angle, double strength)
{
    img frame;
    assert_int_equal(img_new(&frame, SIDE, SIDE, 3), OK);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            const double u = (x + 0.5) / SIDE * 2 - 1, v = 1 - (y + 0.5) / SIDE * 2, r = u * u + v * v;
            const double cosine = r < 1 ? u * cos(angle) + v * sin(angle) + sqrt(1 - r) : 0;
            for (int c = 0; c < 3; c++)
                img_at(&frame, x, y)[c] = (float)(strength * (fmax(cosine, 0) + 0.002 * (rand() % 100) / 100));
        }
    assert_int_equal(frame_looks_add(looks, &frame), OK);
    img_free(&frame);
}

static void each_light_is_taken_once(void **state)
{
    (void)state;
    frame_looks looks = {0};
    size_t chosen[MOST], count;
    /* the lamp rests at four places for ten frames each, brighter and darker */
    for (int i = 0; i < 40; i++)
        add(&looks, 1.5 * (i / 10), i % 2 ? 0.5 : 0.2);
    assert_int_equal(frame_looks_choose(&looks, MOST, chosen, &count), OK);
    assert_int_equal(count, 4);
    for (size_t i = 0; i < 4; i++)
        assert_int_equal(chosen[i] / 10, i);
    frame_looks_free(&looks);
}

static void the_most_different_come_first(void **state)
{
    (void)state;
    frame_looks looks = {0};
    size_t chosen[MOST], count;
    for (int i = 0; i <= 60; i++)
        add(&looks, 0.05 * i, i == 0 ? 0.6 : 0.5);
    assert_int_equal(frame_looks_choose(&looks, 3, chosen, &count), OK);
    assert_int_equal(count, 3);
    assert_true(chosen[1] - chosen[0] > 12 && chosen[2] - chosen[1] > 12);
    frame_looks_free(&looks);
}

static void dark_frames_are_left_out(void **state)
{
    (void)state;
    frame_looks looks = {0};
    size_t chosen[MOST], count;
    for (int i = 0; i < 30; i++)
        add(&looks, i, i % 3 ? 0.01 : 0.5);
    assert_int_equal(frame_looks_choose(&looks, MOST, chosen, &count), OK);
    assert_int_equal(count, MOST);
    for (size_t i = 0; i < count; i++)
        assert_int_equal(chosen[i] % 3, 0);
    frame_looks_free(&looks);
}

static void none_are_chosen_of_none(void **state)
{
    (void)state;
    const frame_looks looks = {0};
    size_t chosen[MOST], count = 1;
    assert_int_equal(frame_looks_choose(&looks, MOST, chosen, &count), OK);
    assert_int_equal(count, 0);
}

/* The first and the last frame differ from all others, and stay in the choice however long the video is. */
static void a_long_video_is_thinned(void **state)
{
    (void)state;
    frame_looks looks = {0};
    size_t chosen[MOST], count;
    img still;
    assert_int_equal(img_new(&still, 2, 2, 3), OK);
    for (size_t i = 0; i < img_value_count(&still); i++)
        still.data[i] = 0.5f;
    add(&looks, 0, 0.5);
    for (int i = 0; i < 40000; i++)
        assert_int_equal(frame_looks_add(&looks, &still), OK);
    assert_true(looks.count < 16385 && looks.step == 4);
    for (int i = 0; i < 8; i++)
        add(&looks, 2, 0.5);
    assert_int_equal(frame_looks_choose(&looks, MOST, chosen, &count), OK);
    assert_int_equal(count, 3);
    assert_int_equal(chosen[0], 0);
    assert_true(chosen[2] > 40000 && chosen[2] < 40009);
    img_free(&still);
    frame_looks_free(&looks);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_light_is_taken_once), cmocka_unit_test(the_most_different_come_first),
        cmocka_unit_test(dark_frames_are_left_out), cmocka_unit_test(none_are_chosen_of_none),
        cmocka_unit_test(a_long_video_is_thinned),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
