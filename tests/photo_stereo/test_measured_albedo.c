/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

#include "image/image.h"
#include "photo_stereo/measured_albedo.h"

enum { SIDE = 16, PIXELS = SIDE * SIDE, OUTSIDE = 5, UNKNOWN = 7, DAZZLED = 9 };

static float truth(int pixel, int channel)
{
    return 0.1f + 0.7f * (float)((pixel * 7 + channel * 3) % 16) / 16;
}

/* Makes maps whose albedo is washed out, and a measured one in another unit in each channel, with faults. */
static void make(int channels, merlin_image *measured, merlin_maps *maps)
{
    static const float unit[3] = {3, 5, 0.2f};
    *maps = (merlin_maps){0};
    assert_int_equal(img_new(measured, SIDE, SIDE, channels), OK);
    assert_int_equal(img_new(&maps->albedo, SIDE, SIDE, 3), OK);
    assert_int_equal(img_new(&maps->mask, SIDE, SIDE, 1), OK);
    for (int i = 0; i < PIXELS; i++) {
        maps->mask.data[i] = i != OUTSIDE;
        for (int c = 0; c < 3; c++)
            maps->albedo.data[3 * i + c] = channels == 1 ? 0.1f * (float)(c + 1) : 0.5f * truth(i, c) + 0.2f;
        for (int c = 0; c < channels; c++)
            measured->data[channels * i + c] = i == UNKNOWN ? 0 : i == DAZZLED ? 1e4f : unit[c] * truth(i, c);
    }
}

static void free_both(merlin_image *measured, merlin_maps *maps)
{
    img_free(measured);
    img_free(&maps->albedo);
    img_free(&maps->mask);
}

/* The measured albedo differs from the truth by one factor in each channel, whatever faults there are. */
static void each_channel_has_its_scale(void **state)
{
    (void)state;
    merlin_image measured;
    merlin_maps maps;
    make(3, &measured, &maps);
    measured_albedo_take(&measured, &maps);
    for (int c = 0; c < 3; c++) {
        const float scale = maps.albedo.data[c] / truth(0, c);
        assert_true(scale > 0.8f && scale < 1.25f);
        for (int i = 0; i < PIXELS; i++)
            if (i != OUTSIDE && i != UNKNOWN && i != DAZZLED)
                assert_true(fabsf(maps.albedo.data[3 * i + c] - fminf(scale * truth(i, c), 1)) < 1e-4f);
        assert_true(maps.albedo.data[3 * DAZZLED + c] == 1);
        assert_true(fabsf(maps.albedo.data[3 * UNKNOWN + c] - (0.5f * truth(UNKNOWN, c) + 0.2f)) < 1e-6f);
        assert_true(fabsf(maps.albedo.data[3 * OUTSIDE + c] - (0.5f * truth(OUTSIDE, c) + 0.2f)) < 1e-6f);
    }
    free_both(&measured, &maps);
}

static void grey_pictures_leave_the_colour(void **state)
{
    (void)state;
    merlin_image measured;
    merlin_maps maps;
    make(1, &measured, &maps);
    measured_albedo_take(&measured, &maps);
    for (int i = 0; i < PIXELS; i++) {
        const float *a = maps.albedo.data + 3 * i;
        if (i == DAZZLED) continue;
        assert_true(fabsf(a[1] / a[0] - 2) < 1e-4f && fabsf(a[2] / a[0] - 3) < 1e-4f);
        if (i == OUTSIDE || i == UNKNOWN) continue;
        assert_true(fabsf(a[0] / maps.albedo.data[0] - truth(i, 0) / truth(0, 0)) < 1e-3f * truth(i, 0) / truth(0, 0));
    }
    free_both(&measured, &maps);
}

static void nothing_measured_changes_nothing(void **state)
{
    (void)state;
    merlin_image measured;
    merlin_maps maps;
    make(3, &measured, &maps);
    for (int i = 0; i < 3 * PIXELS; i++)
        measured.data[i] = i % 2 ? 0 : (float)NAN;
    measured_albedo_take(&measured, &maps);
    for (int i = 0; i < 3 * PIXELS; i++)
        assert_true(fabsf(maps.albedo.data[i] - (0.5f * truth(i / 3, i % 3) + 0.2f)) < 1e-6f);
    free_both(&measured, &maps);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_channel_has_its_scale),
        cmocka_unit_test(grey_pictures_leave_the_colour),
        cmocka_unit_test(nothing_measured_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
