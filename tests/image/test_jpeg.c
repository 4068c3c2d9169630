/* SPDX-License-Identifier: MIT */
#include "image/write/jpeg.h"

#include <stdlib.h>
#include <string.h>

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { WIDTH = 37, HEIGHT = 21, BYTES = WIDTH * HEIGHT * 3 }; /* not multiples of JPEG's blocks */

static void grey_stays_grey(void **unused)
{
    (void)unused;
    uint8_t rgb[BYTES];
    memset(rgb, 100, sizeof rgb);
    assert_int_equal(img_jpeg_round_trip(rgb, WIDTH, HEIGHT, &(img_jpeg){.quality = 75, .halved = true}), OK);
    for (int i = 0; i < BYTES; i++)
        assert_true(abs(rgb[i] - 100) <= 1); /* a block's mean is a multiple of at most 8/8 steps at this quality */
}

static double spoiled(int quality, bool halved)
{
    uint8_t rgb[BYTES], before[BYTES];
    double error = 0;
    for (int i = 0; i < BYTES; i++)
        before[i] = rgb[i] = (uint8_t)(i / 3 % 4 < 2 ? 40 + 60 * (i % 3) : 200 - 50 * (i % 3));
    assert_int_equal(img_jpeg_round_trip(rgb, WIDTH, HEIGHT, &(img_jpeg){.quality = quality, .halved = halved}), OK);
    for (int i = 0; i < BYTES; i++)
        error += abs(rgb[i] - before[i]);
    return error / BYTES;
}

static void lower_quality_and_halved_colour_spoil_more(void **unused)
{
    (void)unused;
    assert_true(spoiled(100, false) < 2);
    assert_true(spoiled(20, false) > 2 * spoiled(95, false));
    assert_true(spoiled(95, true) > 2 * spoiled(95, false));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(grey_stays_grey),
        cmocka_unit_test(lower_quality_and_halved_colour_spoil_more),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
