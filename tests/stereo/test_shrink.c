/* SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

#include "relief.h"
#include "stereo/capture/shrink.h"

enum { SIZE = 10, FACTOR = 4, SMALL_SIZE = 3 };

static void small_pixels_are_the_objects_means(void **state)
{
    (void)state;
    merlin_capture c, small;
    capture_new(&c, SIZE, 1, 3);
    for (int i = 0; i < SIZE * SIZE; i++) {
        c.mask.data[i] = i % SIZE < 6 ? 1 : 0;
        for (int ch = 0; ch < 3; ch++)
            c.picture[0].wide[3 * i + ch] = (uint16_t)(i % SIZE < 6 ? 100 * (i % SIZE) + ch : 9999);
    }
    c.camera.focal = 20;
    assert_int_equal(pst_shrink(&c, pst_blocks_of(&c, FACTOR), PST_SATURATED, &small), OK);
    assert_int_equal(small.width, SMALL_SIZE);
    assert_int_equal(small.height, SMALL_SIZE);
    assert_true(small.camera.focal == 5);
    assert_int_equal(pst_code(&small.picture[0], 0), 150);
    /* columns 4 and 5 of the block's four */
    assert_int_equal(pst_code(&small.picture[0], 3 + 2), 452);
    assert_true(small.mask.data[1] == 1);
    assert_true(small.mask.data[2] == 0);
    assert_int_equal(pst_code(&small.picture[0], 3 * SMALL_SIZE * (SMALL_SIZE - 1)), 150);
    pst_capture_free(&small);
    capture_drop(&c);
}

/* Else a highlight's mean would pass for a value; but a red one says nothing of green. */
static void a_channel_that_holds_a_saturated_pixel_is_saturated(void **state)
{
    (void)state;
    merlin_capture c, small;
    capture_new(&c, SIZE, 1, 3);
    for (int i = 0; i < SIZE * SIZE; i++) {
        c.mask.data[i] = 1;
        c.picture[0].wide[3 * i + 1] = 800;
    }
    c.picture[0].wide[3 * (SIZE + 5)] = 65000;
    assert_int_equal(pst_shrink(&c, pst_blocks_of(&c, FACTOR), PST_SATURATED, &small), OK);
    assert_int_equal(pst_code(&small.picture[0], 0), 0);
    assert_int_equal(pst_code(&small.picture[0], 3), 65535);
    assert_int_equal(pst_code(&small.picture[0], 4), 800);
    pst_capture_free(&small);
    capture_drop(&c);
}

/* Blocks that hang over the edge or hold a pixel beside the object are not wholly on it. */
static void blocks_of_a_part_keep_the_camera_s_rays_and_the_objects_inside(void **state)
{
    (void)state;
    merlin_capture c, small;
    capture_new(&c, SIZE, 1, 1);
    for (int i = 0; i < SIZE * SIZE; i++)
        c.mask.data[i] = i % SIZE < 8 ? 1 : 0;
    c.camera = (pinhole){.focal = 20, .x = 5, .y = 5};
    pst_blocks part = {.x = -1, .y = 1, .columns = 4, .rows = 2, .factor = 3, .whole = true};
    assert_int_equal(pst_shrink(&c, part, PST_SATURATED, &small), OK);
    assert_int_equal(small.width, 4);
    assert_int_equal(small.height, 2);
    assert_true(small.camera.x == 2 && fabsf(small.camera.y - 4.0f / 3) < 1e-6f);
    const float inside[4] = {0, 1, 1, 0}; /* columns -1 to 1, 2 to 4, 5 to 7, 8 to 10 */
    for (int i = 0; i < 8; i++)
        assert_true(small.mask.data[i] == inside[i % 4]);
    pst_capture_free(&small);
    capture_drop(&c);
}

/* Where all four small pixels around are on the object; elsewhere it stays within their range. */
static void an_enlarged_slope_is_the_slope(void **state)
{
    (void)state;
    merlin_capture c, small;
    img depth, large;
    capture_new(&c, SIZE, 1, 1);
    for (int i = 0; i < SIZE * SIZE; i++)
        c.mask.data[i] = i % SIZE < 8 ? 1 : 0;
    assert_int_equal(pst_shrink(&c, pst_blocks_of(&c, FACTOR), PST_SATURATED, &small), OK);
    assert_int_equal(img_new(&depth, SMALL_SIZE, SMALL_SIZE, 1), OK);
    assert_int_equal(img_new(&large, SIZE, SIZE, 1), OK);
    for (int i = 0; i < SMALL_SIZE * SMALL_SIZE; i++)
        depth.data[i] = 1 + (float)(i % SMALL_SIZE);
    pst_enlarge(&depth, &small.mask, &c.mask, FACTOR, &large);
    for (int x = 2; x < 6; x++)
        assert_true(fabsf(large.data[5 * SIZE + x] - (1 + ((float)x + 0.5f) / FACTOR - 0.5f)) < 1e-6f);
    assert_true(large.data[0] == 1);
    assert_true(large.data[SIZE * SIZE - 3] == 2);
    assert_true(large.data[SIZE - 1] == 0);
    img_free(&large);
    img_free(&depth);
    pst_capture_free(&small);
    capture_drop(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(small_pixels_are_the_objects_means),
        cmocka_unit_test(a_channel_that_holds_a_saturated_pixel_is_saturated),
        cmocka_unit_test(blocks_of_a_part_keep_the_camera_s_rays_and_the_objects_inside),
        cmocka_unit_test(an_enlarged_slope_is_the_slope),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
