/* SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/status.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

#include "photo_stereo/align_pictures.h"
#include "relief.h"

enum { SIZE = 96, LIGHTS = 6, MANY = 16 };
static const int dx[LIGHTS] = {0, 3, -4, 0, 2, 0}, dy[LIGHTS] = {0, -2, 1, 5, 2, 0};

/* Moves a picture's content to the right and down. */
static void move(merlin_capture *c, int k, int x, int y)
{
    const size_t channels = (size_t)c->channels, values = (size_t)SIZE * SIZE * channels;
    uint16_t *to = calloc(values, sizeof *to);
    assert_non_null(to);
    for (int j = 0; j < SIZE; j++)
        for (int i = 0; i < SIZE; i++)
            if (i - x >= 0 && i - x < SIZE && j - y >= 0 && j - y < SIZE)
                memcpy(to + ((size_t)j * SIZE + (size_t)i) * channels,
                       c->picture[k].wide + ((size_t)(j - y) * SIZE + (size_t)(i - x)) * channels,
                       channels * sizeof *to);
    memcpy(c->picture[k].wide, to, values * sizeof *to);
    free(to);
}

/* The first ones of many lights are near the axis. */
static void make_under(int lights, int channels, merlin_capture *c)
{
    const relief sphere = {.size = SIZE, .lights = lights, .channels = channels, .exposure = 1.5f};
    relief_capture(&sphere, c);
    /* painted, as few real objects are plain */
    for (int k = 0; k < lights; k++)
        for (int i = 0; i < SIZE * SIZE * channels; i++) {
            const int across = i / channels % SIZE / 7, down = i / channels / SIZE / 9;
            if (across * across * down % 3 == 1 || across * down % 5 == 2)
                c->picture[k].wide[i] = (uint16_t)(c->picture[k].wide[i] / 2);
        }
}

static void make(int channels, merlin_capture *c)
{
    make_under(LIGHTS, channels, c);
}

static void still_pictures_stay(void **state)
{
    (void)state;
    merlin_capture c, aligned;
    picture_shifts shifts;
    make(3, &c);
    assert_int_equal(align_pictures(&c, &aligned, &shifts), OK);
    assert_int_equal(shifts.moved, 0);
    for (int k = 0; k < LIGHTS; k++)
        assert_ptr_equal(aligned.picture[k].wide, c.picture[k].wide);
    align_pictures_free(&c, &aligned);
    capture_drop(&c);
}

static void moved_pictures_come_back(int channels, bool masked)
{
    merlin_capture c, still, aligned;
    picture_shifts shifts;
    make(channels, &c);
    make(channels, &still);
    for (int k = 0; k < LIGHTS; k++)
        move(&c, k, dx[k], dy[k]);
    img mask = c.mask;
    if (!masked) c.mask = (img){0};
    assert_int_equal(align_pictures(&c, &aligned, &shifts), OK);
    assert_int_equal(shifts.moved, 4);
    assert_int_equal(shifts.which, 3);
    assert_int_equal(shifts.most, 5);
    for (int k = 0; k < LIGHTS; k++)
        for (int j = 8; j < SIZE - 8; j++)
            assert_memory_equal(aligned.picture[k].wide + (size_t)(j * SIZE + 8) * (size_t)channels,
                                still.picture[k].wide + (size_t)(j * SIZE + 8) * (size_t)channels,
                                sizeof(uint16_t) * (SIZE - 16) * (size_t)channels);
    align_pictures_free(&c, &aligned);
    c.mask = mask;
    capture_drop(&c);
    capture_drop(&still);
}

static void what_moved_comes_back(void **state)
{
    (void)state;
    moved_pictures_come_back(3, true);
    moved_pictures_come_back(1, false);
}

static void what_moved_too_far_is_refused(void **state)
{
    (void)state;
    merlin_capture c, aligned;
    picture_shifts shifts;
    make(3, &c);
    move(&c, 2, 12, -6);
    assert_int_equal(align_pictures(&c, &aligned, &shifts), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "the object is about 13 pixels aside"));
    assert_null(aligned.picture);
    c.count = 2;
    move(&c, 1, 12, -9);
    assert_int_equal(align_pictures(&c, &aligned, &shifts), MERLIN_BAD_INPUT);
    c.count = LIGHTS;
    capture_drop(&c);
}

/* Moves all pictures by up to this far, each to another place, and returns what align_pictures says. */
static status align_all_moved(int far, picture_shifts *shifts)
{
    static const int side[LIGHTS][2] = {{-6, 5}, {6, -6}, {-5, -6}, {6, 6}, {-6, 0}, {5, -5}};
    merlin_capture c, still, aligned;
    make_under(MANY, 3, &c);
    make_under(MANY, 3, &still);
    c.count = LIGHTS;
    for (int k = 0; k < LIGHTS; k++)
        move(&c, k, side[k][0] * far / 6, side[k][1] * far / 6);
    move(&still, 1, side[0][0] * far / 6, side[0][1] * far / 6);
    status s = align_pictures(&c, &aligned, shifts);
    for (int j = 16; s == OK && j < SIZE - 16; j++) {
        const size_t from = (size_t)(j * SIZE + 16) * 3;
        assert_memory_equal(aligned.picture[1].wide + from, still.picture[1].wide + from,
                            sizeof(uint16_t) * (SIZE - 32) * 3);
    }
    if (s == OK) align_pictures_free(&c, &aligned);
    c.count = MANY;
    capture_drop(&c);
    capture_drop(&still);
    return s;
}

/* The sum of the others is a blur then. */
static void pictures_that_all_moved_come_back(void **state)
{
    (void)state;
    picture_shifts shifts;
    if (align_all_moved(6, &shifts) != OK) fail_msg("%s", status_message());
    assert_int_equal(shifts.moved, LIGHTS - 1);
    assert_int_equal(align_all_moved(12, &shifts), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "the object moved by about"));
}

/* Two pictures are lit in different places, which may be alike by chance if one is moved. */
static void two_pictures_under_far_lights_did_not_move(void **state)
{
    (void)state;
    const relief bumps = {.size = SIZE, .lights = 24, .channels = 1, .bump = 8, .exposure = 1.5f, .cast_shadows = true};
    merlin_capture all, aligned;
    picture_shifts shifts;
    relief_capture(&bumps, &all);
    for (int a = 0; a < 10; a++)
        for (int b = 0; b < a; b++) {
            merlin_capture two = all;
            pst_plane pair[] = {all.picture[a], all.picture[b]};
            two.count = 2;
            two.picture = pair;
            if (align_pictures(&two, &aligned, &shifts) != OK) fail_msg("%d and %d: %s", a, b, status_message());
            align_pictures_free(&two, &aligned);
        }
    capture_drop(&all);
}

/* Leaves a picture dark but for a square, which is shown so many pixels aside of its place. */
static void keep_square(merlin_capture *c, int k, int first, int side, int by)
{
    uint16_t square[SIZE][SIZE] = {{0}};
    for (int y = first; y < first + side; y++)
        memcpy(&square[y + by][first + by], c->picture[k].wide + y * SIZE + first, (size_t)side * sizeof **square);
    memcpy(c->picture[k].wide, square, sizeof square);
}

/* A few places are lit, which are alike, as bands along an outline are under lamps far aside. */
static void what_is_lit_elsewhere_did_not_move(void **state)
{
    (void)state;
    merlin_capture c, aligned;
    picture_shifts shifts;
    make(1, &c);
    for (int k = 0; k < LIGHTS; k++)
        keep_square(&c, k, 30, 18, k == LIGHTS - 1 ? 20 : 0);
    if (align_pictures(&c, &aligned, &shifts) != OK) fail_msg("%s", status_message());
    assert_int_equal(shifts.moved, 0);
    align_pictures_free(&c, &aligned);
    capture_drop(&c);
}

/* What is alike in all pictures, as a dark ball's highlight is, travels with the lamp. */
static void a_highlight_that_travels_is_no_move(void **state)
{
    (void)state;
    static const int by[LIGHTS] = {0, 14, 28, 14, 0, 28};
    merlin_capture c, aligned;
    picture_shifts shifts;
    make(1, &c);
    for (int k = 0; k < LIGHTS; k++)
        keep_square(&c, k, 24, 16, by[k]);
    if (align_pictures(&c, &aligned, &shifts) != OK) fail_msg("%s", status_message());
    align_pictures_free(&c, &aligned);
    capture_drop(&c);
}

static void one_picture_has_nothing_to_fit(void **state)
{
    (void)state;
    merlin_capture c, aligned;
    picture_shifts shifts;
    make(1, &c);
    const int count = c.count;
    c.count = 1;
    assert_int_equal(align_pictures(&c, &aligned, &shifts), OK);
    assert_ptr_equal(aligned.picture[0].wide, c.picture[0].wide);
    align_pictures_free(&c, &aligned);
    c.count = count;
    capture_drop(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(still_pictures_stay),
        cmocka_unit_test(what_moved_comes_back),
        cmocka_unit_test(what_moved_too_far_is_refused),
        cmocka_unit_test(pictures_that_all_moved_come_back),
        cmocka_unit_test(what_is_lit_elsewhere_did_not_move),
        cmocka_unit_test(a_highlight_that_travels_is_no_move),
        cmocka_unit_test(two_pictures_under_far_lights_did_not_move),
        cmocka_unit_test(one_picture_has_nothing_to_fit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
