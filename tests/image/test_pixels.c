/* SPDX-License-Identifier: MIT */
/* Tests images from and to buffers that a program has in memory. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "image/color.h"
#include "image/image.h"

#include <cmocka.h> /* behind ours: it has a macro named fail */

static void every_code_comes_back(void **state)
{
    (void)state;
    for (int wide = 0; wide < 2; wide++)
        for (int linear = 0; linear < 2; linear++) {
            const int side = wide ? 256 : 16;
            const merlin_pixel_layout layout = {.width = side,
                                                .height = side,
                                                .channels = 1,
                                                .type = wide ? MERLIN_PIXEL_16 : MERLIN_PIXEL_8,
                                                .linear = linear};
            const size_t size = (size_t)side * (size_t)side * (wide ? 2 : 1);
            uint8_t *codes = malloc(size), *back = calloc(1, size);
            merlin_image image, grey;
            for (size_t i = 0; i < size / (wide ? 2 : 1); i++) {
                uint16_t code = (uint16_t)i;
                if (wide)
                    memcpy(codes + 2 * i, &code, 2);
                else
                    codes[i] = (uint8_t)i;
            }
            assert_int_equal(merlin_image_from_pixels(codes, &layout, &image, NULL), MERLIN_OK);
            assert_int_equal(image.channels, 3);
            assert_int_equal(img_new(&grey, side, side, 1), OK);
            for (size_t i = 0; i < img_value_count(&grey); i++)
                grey.data[i] = image.data[3 * i];
            assert_int_equal(merlin_image_to_pixels(&grey, NULL, &layout, back), MERLIN_OK);
            assert_memory_equal(codes, back, size);
            free(codes);
            free(back);
            merlin_image_free(&image);
            merlin_image_free(&grey);
        }
}

static void colours_are_decoded_and_alpha_is_not(void **state)
{
    (void)state;
    const uint8_t pixels[] = {255, 0, 128, 64, 10, 20, 30, 255};
    const merlin_pixel_layout layout = {.width = 2, .height = 1, .channels = 4};
    merlin_image color, alpha;
    assert_int_equal(merlin_image_from_pixels(pixels, &layout, &color, &alpha), MERLIN_OK);
    for (int i = 0; i < 6; i++)
        assert_true(color.data[i] == srgb_decode_table8()[pixels[i + i / 3]]);
    assert_true(alpha.data[0] == 64 / 255.0f && alpha.data[1] == 1);
    merlin_image_free(&color);
    merlin_image_free(&alpha);
}

static void an_opaque_alpha_is_none_and_a_transparent_one_is_refused(void **state)
{
    (void)state;
    const merlin_pixel_layout layout = {.width = 1, .height = 1, .channels = 4};
    merlin_image color, alpha;
    assert_int_equal(merlin_image_from_pixels((const uint8_t[]){1, 2, 3, 255}, &layout, &color, &alpha), MERLIN_OK);
    assert_null(alpha.data);
    merlin_image_free(&color);
    assert_int_equal(merlin_image_from_pixels((const uint8_t[]){1, 2, 3, 0}, &layout, &color, &alpha),
                     MERLIN_BAD_INPUT);
    assert_null(color.data);
    assert_int_equal(merlin_image_from_pixels((const uint8_t[]){1, 2, 3, 0}, &layout, &color, NULL), MERLIN_OK);
    merlin_image_free(&color);
}

static void rows_may_have_gaps_stand_askew_and_go_upwards(void **state)
{
    (void)state;
    enum { WIDTH = 3, HEIGHT = 4, STRIDE = 3 * WIDTH * sizeof(float) + 5 };
    char buffer[HEIGHT * STRIDE + 1], *askew = buffer + 1;
    float value = 0.25f;
    memset(buffer, 0, sizeof buffer);
    for (int y = 0; y < HEIGHT; y++)
        for (size_t i = 0; i < 3 * WIDTH; i++, value += 1.5f)
            memcpy(askew + y * STRIDE + i * sizeof value, &value, sizeof value);
    merlin_pixel_layout layout = {
        .width = WIDTH, .height = HEIGHT, .channels = 3, .type = MERLIN_PIXEL_FLOAT, .linear = 1, .stride = STRIDE};
    merlin_image down, up;
    assert_int_equal(merlin_image_from_pixels(askew, &layout, &down, NULL), MERLIN_OK);
    assert_true(down.data[0] == 0.25f && down.data[3 * WIDTH * HEIGHT - 1] == value - 1.5f);
    layout.stride = -STRIDE;
    assert_int_equal(merlin_image_from_pixels(askew + (HEIGHT - 1) * STRIDE, &layout, &up, NULL), MERLIN_OK);
    for (int y = 0; y < HEIGHT; y++)
        assert_memory_equal(img_at(&up, 0, y), img_at(&down, 0, HEIGHT - 1 - y), 3 * WIDTH * sizeof(float));
    char written[sizeof buffer] = {0};
    assert_int_equal(merlin_image_to_pixels(&up, NULL, &layout, written + 1 + (HEIGHT - 1) * STRIDE), MERLIN_OK);
    assert_memory_equal(written, buffer, sizeof buffer); /* and the gaps are left alone */
    merlin_image_free(&down);
    merlin_image_free(&up);
}

static void a_mask_is_taken_as_it_is(void **state)
{
    (void)state;
    const uint16_t pixels[] = {0, 65535, 32768};
    merlin_pixel_layout layout = {.width = 3, .height = 1, .channels = 1, .type = MERLIN_PIXEL_16};
    merlin_image mask;
    assert_int_equal(merlin_mask_from_pixels(pixels, &layout, &mask), MERLIN_OK);
    assert_int_equal(mask.channels, 1);
    assert_true(mask.data[0] == 0 && mask.data[1] == 1 && mask.data[2] == 32768 / 65535.0f);
    merlin_image_free(&mask);
    layout.channels = 3;
    layout.width = 1;
    assert_int_equal(merlin_mask_from_pixels(pixels, &layout, &mask), MERLIN_WRONG_USE);
}

static void what_is_not_finite_becomes_a_code_all_the_same(void **state)
{
    (void)state;
    float values[] = {-1, 2, NAN};
    merlin_image image = {3, 1, 1, values};
    uint8_t narrow[3];
    uint16_t wide[3];
    for (int linear = 0; linear < 2; linear++) {
        merlin_pixel_layout layout = {.width = 3, .height = 1, .channels = 1, .linear = linear};
        assert_int_equal(merlin_image_to_pixels(&image, NULL, &layout, narrow), MERLIN_OK);
        assert_true(narrow[0] == 0 && narrow[1] == 255 && narrow[2] == 0);
        layout.type = MERLIN_PIXEL_16;
        assert_int_equal(merlin_image_to_pixels(&image, NULL, &layout, wide), MERLIN_OK);
        assert_true(wide[0] == 0 && wide[1] == 65535 && wide[2] == 0);
    }
}

static void layouts_that_cannot_be_are_refused(void **state)
{
    (void)state;
    const uint8_t pixels[16] = {0};
    uint8_t out[16];
    static const merlin_pixel_layout wrong[] = {
        {.width = 0, .height = 1, .channels = 3},
        {.width = 1, .height = -1, .channels = 3},
        {.width = 1, .height = 1, .channels = 2},
        {.width = 1, .height = 1, .channels = 3, .type = (merlin_pixel_type)7},
        {.width = 2, .height = 2, .channels = 3, .stride = 5},
        {.width = 2, .height = 2, .channels = 3, .stride = -5},
    };
    merlin_image image = {0};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        assert_int_equal(merlin_image_from_pixels(pixels, &wrong[i], &image, NULL), MERLIN_WRONG_USE);
    const merlin_pixel_layout grey = {.width = 1, .height = 1, .channels = 1};
    assert_int_equal(merlin_image_from_pixels(NULL, &grey, &image, NULL), MERLIN_WRONG_USE);
    assert_int_equal(merlin_image_to_pixels(&image, NULL, &grey, out), MERLIN_WRONG_USE); /* no pixels */
    assert_int_equal(img_new(&image, 1, 1, 3), OK);
    assert_int_equal(merlin_image_to_pixels(&image, NULL, &grey, out), MERLIN_WRONG_USE);
    merlin_image_free(&image);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_code_comes_back),
        cmocka_unit_test(colours_are_decoded_and_alpha_is_not),
        cmocka_unit_test(an_opaque_alpha_is_none_and_a_transparent_one_is_refused),
        cmocka_unit_test(rows_may_have_gaps_stand_askew_and_go_upwards),
        cmocka_unit_test(a_mask_is_taken_as_it_is),
        cmocka_unit_test(what_is_not_finite_becomes_a_code_all_the_same),
        cmocka_unit_test(layouts_that_cannot_be_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
