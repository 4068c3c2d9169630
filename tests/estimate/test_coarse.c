/* SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

#include <math.h>

#include "estimate/surface/coarse.h"
#include "image/resize.h"

enum { FINE = 96, COARSE = 32 };

/* A dome with fine stripes of colour, in a round mask. */
static void make_fine(surface *out)
{
    assert_int_equal(surface_new(FINE, FINE, out), OK);
    for (int y = 0; y < FINE; y++)
        for (int x = 0; x < FINE; x++) {
            const size_t i = (size_t)y * FINE + (size_t)x;
            const float u = ((float)x + 0.5f) / FINE - 0.5f, v = 0.5f - ((float)y + 0.5f) / FINE;
            if (u * u + v * v > 0.2f) continue;
            out->mask.data[i] = 1;
            for (int ch = 0; ch < 3; ch++)
                out->albedo.data[3 * i + (size_t)ch] = x % 4 < 2 ? 0.3f : 0.2f;
            vec3_put(vec3_normalize(vec3_make(u, v, 1)), out->normal.data + 3 * i);
            out->roughness.data[i] = x % 6 < 3 ? 0.4f : 0.3f;
            out->depth.data[i] = 1 + u * u + v * v;
        }
}

static void make_coarse(const surface *fine, surface *out)
{
    img mask = {0};
    assert_int_equal(img_resize(&fine->mask, COARSE, COARSE, &mask), OK);
    harden_mask(NULL, &mask);
    assert_int_equal(surface_resize(fine, &mask, out), OK);
    img_free(&mask);
}

/* Tells whether a pixel is far enough from the outline to be without its errors. */
static bool is_inner(int i)
{
    const int x = i % FINE - FINE / 2, y = i / FINE - FINE / 2;
    return x * x + y * y < 30 * 30;
}

static void an_equal_estimate_changes_nothing(void **state)
{
    (void)state;
    surface fine, before, coarse;
    make_fine(&fine);
    make_fine(&before);
    make_coarse(&fine, &coarse);
    assert_int_equal(surface_take_coarse(&coarse, (coarse_share){1, 1, 1, 1}, &fine), OK);
    for (int i = 0; i < FINE * FINE; i++) {
        assert_float_equal(fine.albedo.data[3 * i], before.albedo.data[3 * i], 1e-5);
        assert_float_equal(fine.normal.data[3 * i], before.normal.data[3 * i], 1e-5);
        assert_float_equal(fine.roughness.data[i], before.roughness.data[i], 1e-5);
        assert_float_equal(fine.depth.data[i], before.depth.data[i], 1e-5);
    }
    surface_free(&fine);
    surface_free(&before);
    surface_free(&coarse);
}

/* A share of the difference is taken, and the stripes that the other estimate does not see stay. */
static void the_coarse_part_is_taken_and_detail_stays(void **state)
{
    (void)state;
    surface fine, before, coarse;
    make_fine(&fine);
    make_fine(&before);
    make_coarse(&fine, &coarse);
    for (int i = 0; i < COARSE * COARSE; i++) {
        if (coarse.mask.data[i] == 0) continue;
        for (int ch = 0; ch < 3; ch++)
            coarse.albedo.data[3 * i + ch] *= 2;
        vec3_put(vec3_normalize(vec3_add(vec3_of(coarse.normal.data + 3 * i), vec3_make(0.2f, 0, 0))),
                 coarse.normal.data + 3 * i);
        coarse.roughness.data[i] += 0.2f;
        coarse.depth.data[i] += 0.1f;
    }
    assert_int_equal(surface_take_coarse(&coarse, (coarse_share){1, 0.5f, 1, 0.5f}, &fine), OK);
    for (int i = 0; i < FINE * FINE; i++) {
        if (!is_inner(i)) continue;
        assert_float_equal(fine.albedo.data[3 * i], 2 * before.albedo.data[3 * i], 0.02);
        const float old = before.normal.data[3 * i] / before.normal.data[3 * i + 2],
                    new = fine.normal.data[3 * i] / fine.normal.data[3 * i + 2];
        assert_float_equal(new - old, 0.1, 0.03);
        assert_float_equal(fine.roughness.data[i], before.roughness.data[i] + 0.2f, 1e-3);
        assert_float_equal(fine.depth.data[i], before.depth.data[i] + 0.05f, 1e-3);
    }
    surface_free(&fine);
    surface_free(&before);
    surface_free(&coarse);
}

static void ratios_of_albedo_are_limited(void **state)
{
    (void)state;
    surface fine, coarse;
    make_fine(&fine);
    make_coarse(&fine, &coarse);
    for (int i = 0; i < 3 * COARSE * COARSE; i++)
        coarse.albedo.data[i] /= 1000;
    assert_int_equal(surface_take_coarse(&coarse, (coarse_share){1, 1, 1, 1}, &fine), OK);
    for (int i = 0; i < FINE * FINE; i++)
        if (is_inner(i)) assert_true(fine.albedo.data[3 * i] > 0.2f / 4.1f);
    surface_free(&fine);
    surface_free(&coarse);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_equal_estimate_changes_nothing),
        cmocka_unit_test(the_coarse_part_is_taken_and_detail_stays),
        cmocka_unit_test(ratios_of_albedo_are_limited),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
