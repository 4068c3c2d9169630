/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include "base/rng.h"
#include "lab/eval/metrics/metrics.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

static img filled(int width, int height, int channels, float value)
{
    img image;
    assert_int_equal(img_new(&image, width, height, channels), OK);
    for (int i = 0; i < width * height * channels; i++)
        image.data[i] = value;
    return image;
}

static img noise(int width, int height, int channels, uint64_t seed)
{
    img image = filled(width, height, channels, 0);
    rng r = rng_at(seed, 0, 0);
    for (int i = 0; i < width * height * channels; i++)
        image.data[i] = rng_uniform(&r);
    return image;
}

/* The definition with its 2D window, one window at a time. */
static double plain_window(const img *a, const img *b, int x0, int y0, int c)
{
    double ma = 0, mb = 0, vaa = 0, vbb = 0, vab = 0, total = 0;
    for (int pass = 0; pass < 2; pass++) {
        for (int j = 0; j < 11; j++) {
            for (int i = 0; i < 11; i++) {
                double g = exp(-((i - 5) * (i - 5) + (j - 5) * (j - 5)) / (2 * 1.5 * 1.5));
                double p = img_at(a, x0 + i, y0 + j)[c], q = img_at(b, x0 + i, y0 + j)[c];
                if (pass == 0) {
                    total += g;
                    ma += g * p;
                    mb += g * q;
                } else {
                    vaa += g / total * (p - ma) * (p - ma);
                    vbb += g / total * (q - mb) * (q - mb);
                    vab += g / total * (p - ma) * (q - mb);
                }
            }
        }
        if (pass == 0) {
            ma /= total;
            mb /= total;
        }
    }
    return (2 * ma * mb + 1e-4) * (2 * vab + 9e-4) / ((ma * ma + mb * mb + 1e-4) * (vaa + vbb + 9e-4));
}

static void similarity_agrees_with_its_plain_definition(void **state)
{
    (void)state;
    img a = noise(24, 17, 3, 1), b = noise(24, 17, 3, 2);
    for (int i = 0; i < 24 * 17 * 3; i++)
        b.data[i] = 0.7f * a.data[i] + 0.3f * b.data[i];
    double sum = 0, got;
    for (int c = 0; c < 3; c++)
        for (int y = 0; y < 7; y++)
            for (int x = 0; x < 14; x++)
                sum += plain_window(&a, &b, x, y, c);
    assert_int_equal(eval_ssim(&a, &b, &got), OK);
    /* both in double; the variance as E[x²] - E[x]² loses a few digits */
    assert_true(fabs(got - sum / (3 * 7 * 14)) < 1e-12);
    img_free(&a);
    img_free(&b);
}

static void similarity_of_an_image_with_itself_is_one(void **state)
{
    (void)state;
    img a = noise(31, 20, 3, 3);
    double got;
    assert_int_equal(eval_ssim(&a, &a, &got), OK);
    assert_true(fabs(got - 1) < 1e-12);
    img_free(&a);
}

static void similarity_of_flat_images_compares_their_brightness(void **state)
{
    (void)state;
    img a = filled(16, 16, 1, 0.25f), b = filled(16, 16, 1, 0.75f);
    double got, want = (2 * 0.25 * 0.75 + 1e-4) / (0.25 * 0.25 + 0.75 * 0.75 + 1e-4);
    assert_int_equal(eval_ssim(&a, &b, &got), OK);
    assert_true(fabs(got - want) < 1e-12);
    img_free(&a);
    img_free(&b);
}

static void similarity_of_a_pattern_and_its_negative_is_below_zero(void **state)
{
    (void)state;
    img a = noise(32, 32, 1, 4), b = filled(32, 32, 1, 0);
    for (int i = 0; i < 32 * 32; i++)
        b.data[i] = 1 - a.data[i];
    double got, back;
    assert_int_equal(eval_ssim(&a, &b, &got), OK);
    assert_int_equal(eval_ssim(&b, &a, &back), OK);
    assert_true(got < -0.9);
    assert_true(fabs(got - back) < 1e-12);
    img_free(&a);
    img_free(&b);
}

static void similarity_refuses_images_that_do_not_match(void **state)
{
    (void)state;
    img a = filled(16, 16, 3, 0), b = filled(16, 17, 3, 0), small = filled(10, 16, 3, 0);
    double got;
    assert_int_equal(eval_ssim(&a, &b, &got), MERLIN_WRONG_USE);
    assert_int_equal(eval_ssim(&small, &small, &got), MERLIN_WRONG_USE);
    img_free(&a);
    img_free(&b);
    img_free(&small);
}

static void squared_error_counts_the_mask_alone(void **state)
{
    (void)state;
    img a = filled(8, 8, 3, 0.5f), b = filled(8, 8, 3, 0.5f), mask = filled(8, 8, 1, 0);
    for (int i = 0; i < 32; i++)
        mask.data[i] = 1;
    for (int i = 0; i < 32; i++)
        b.data[3 * i] = 1.5f; /* one channel of three, by 1 */
    for (int i = 32 * 3; i < 64 * 3; i++)
        b.data[i] = 100;
    assert_true(fabs(eval_mse(&a, &b, &mask) - 1.0 / 3) < 1e-12);
    for (int i = 0; i < 64; i++)
        mask.data[i] = 0;
    assert_true(eval_mse(&a, &b, &mask) == 0);
    img_free(&a);
    img_free(&b);
    img_free(&mask);
}

static void angle_between_normals_is_in_degrees_and_exact_when_small(void **state)
{
    (void)state;
    const double angles[] = {1e-3, 1, 30, 90, 179};
    img a = filled(4, 4, 3, 0), b = filled(4, 4, 3, 0), mask = filled(4, 4, 1, 1);
    for (int k = 0; k < 5; k++) {
        double radians = angles[k] * 3.14159265358979 / 180;
        for (int i = 0; i < 16; i++) {
            a.data[3 * i + 2] = 1;
            b.data[3 * i] = (float)sin(radians);
            b.data[3 * i + 2] = (float)cos(radians);
        }
        /* float's rounding of sine and cosine */
        assert_true(fabs(eval_angle(&a, &b, &mask) - angles[k]) < 1e-5);
    }
    img_free(&a);
    img_free(&b);
    img_free(&mask);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(similarity_agrees_with_its_plain_definition),
        cmocka_unit_test(similarity_of_an_image_with_itself_is_one),
        cmocka_unit_test(similarity_of_flat_images_compares_their_brightness),
        cmocka_unit_test(similarity_of_a_pattern_and_its_negative_is_below_zero),
        cmocka_unit_test(similarity_refuses_images_that_do_not_match),
        cmocka_unit_test(squared_error_counts_the_mask_alone),
        cmocka_unit_test(angle_between_normals_is_in_degrees_and_exact_when_small),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
