/* SPDX-License-Identifier: MIT */
#include <math.h>

#include "image/resize.h"
#include "image/write/write.h"

#include "writes.h"

static float noise(unsigned i)
{
    i = (i ^ 61u) ^ (i >> 16);
    i *= 0x9e3779b9u;
    i ^= i >> 15;
    i *= 0x27d4eb2du;
    return (float)(i >> 8) * 0x1p-24f;
}

static img make(int width, int height, int channels)
{
    img image;
    assert_int_equal(img_new(&image, width, height, channels), OK);
    return image;
}

static size_t count_of(const img *i)
{
    return (size_t)i->width * (size_t)i->height * (size_t)i->channels;
}

static double mean_of(const img *i)
{
    double sum = 0;
    for (size_t k = 0; k < count_of(i); k++)
        sum += i->data[k];
    return sum / (double)count_of(i);
}

static void sizes_that_cannot_be_are_refused(void **state)
{
    (void)state;
    img image;
    assert_int_equal(img_new(&image, 0, 5, 1), MERLIN_WRONG_USE);
    assert_null(image.data);
    assert_int_equal(img_new(&image, 5, -1, 1), MERLIN_WRONG_USE);
    assert_int_equal(img_new(&image, 0x7fffffff, 0x7fffffff, 0x7fffffff), MERLIN_NO_MEMORY);
    assert_null(image.data);
    img_free(&image);
}

static void shrinking_keeps_the_mean(void **state)
{
    (void)state;
    img from = make(37, 53, 3), to;
    for (size_t i = 0; i < count_of(&from); i++)
        from.data[i] = noise((unsigned)i);
    assert_int_equal(img_resize(&from, 11, 20, &to), OK);
    /* each pixel is an area's mean, so that only float rounding is left */
    assert_true(fabs(mean_of(&to) - mean_of(&from)) < 1e-6);
    img_free(&to);
    assert_int_equal(img_resize(&from, 1, 1, &to), OK);
    assert_true(fabs(mean_of(&to) - mean_of(&from)) < 1e-6);
    img_free(&to);
    img_free(&from);
}

static void constants_stay_constant_at_any_size(void **state)
{
    (void)state;
    static const int sizes[][2] = {{1, 1}, {3, 50}, {64, 7}, {200, 200}, {12, 9}};
    img from = make(12, 9, 2);
    for (size_t i = 0; i < count_of(&from); i++)
        from.data[i] = i % 2 ? 0.25f : 3;
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        img to;
        assert_int_equal(img_resize(&from, sizes[k][0], sizes[k][1], &to), OK);
        assert_int_equal(to.width, sizes[k][0]);
        assert_int_equal(to.height, sizes[k][1]);
        for (size_t i = 0; i < count_of(&to); i++)
            assert_true(fabsf(to.data[i] - (i % 2 ? 0.25f : 3)) < 1e-5f);
        img_free(&to);
    }
    img_free(&from);
}

static void enlarging_follows_a_smooth_wave(void **state)
{
    (void)state;
    enum { SMALL = 64, LARGE = 192 };
    img from = make(SMALL, 1, 1), to;
    for (int x = 0; x < SMALL; x++)
        from.data[x] = cosf((float)(x + 0.5) / 8 * 3.14159265f);
    assert_int_equal(img_resize(&from, LARGE, 1, &to), OK);
    /* 16 samples a period: Lanczos-3's ripple there is below 1 % (its weights' sum before normalization); edges
     * excluded */
    for (int x = 12; x < LARGE - 12; x++)
        assert_true(fabsf(to.data[x] - cosf((float)(x + 0.5) / 3 / 8 * 3.14159265f)) < 0.01f);
    img_free(&from);
    img_free(&to);
}

static void under_a_cover_enlarging_is_the_same_and_beside_it_zero(void **state)
{
    (void)state;
    img from = make(9, 7, 2), cover = make(31, 40, 1), all, some;
    for (size_t i = 0; i < count_of(&from); i++)
        from.data[i] = sinf((float)i);
    for (int y = 11; y < 29; y++)
        for (int x = 5 + y / 4; x < 20; x += 7)
            *img_at(&cover, x, y) = 0.5f;
    assert_int_equal(img_resize(&from, 31, 40, &all), OK);
    assert_int_equal(img_resize_covered(&from, &cover, &some), OK);
    for (int y = 0; y < 40; y++) {
        img_span span = img_row_span(&cover, y);
        assert_int_equal(span.end > span.first, y >= 11 && y < 29);
        for (int x = 0; x < 31; x++) {
            bool inside = x >= span.first && x < span.end;
            assert_true(img_at(&some, x, y)[1] == (inside ? img_at(&all, x, y)[1] : 0));
        }
    }
    img_free(&some);
    assert_int_equal(img_resize_covered(&all, &cover, &some), OK);
    assert_true(img_at(&some, 10, 20)[0] == img_at(&all, 10, 20)[0] && img_at(&some, 10, 5)[0] == 0);
    img_free(&some);
    img_free(&all);
    img_free(&cover);
    img_free(&from);
}

static void crop_beyond_the_edges_is_zero_there(void **state)
{
    (void)state;
    img from = make(4, 3, 2), to;
    for (size_t i = 0; i < count_of(&from); i++)
        from.data[i] = (float)(i + 1);
    assert_int_equal(img_crop(&from, -1, 1, 6, 4, &to), OK);
    for (int y = 0; y < 4; y++)
        for (int x = 0; x < 6; x++)
            for (int c = 0; c < 2; c++) {
                bool inside = x >= 1 && x < 5 && y < 2;
                assert_true(img_at(&to, x, y)[c] == (inside ? img_at(&from, x - 1, y + 1)[c] : 0));
            }
    img_free(&to);
    assert_int_equal(img_crop(&from, 10, -9, 2, 2, &to), OK);
    assert_true(mean_of(&to) == 0);
    img_free(&to);
    img_free(&from);
}

static void guided_upsampling_keeps_constants(void **state)
{
    (void)state;
    img low = make(16, 12, 2), guide = make(61, 50, 3), out;
    for (size_t i = 0; i < count_of(&low); i++)
        low.data[i] = i % 2 ? -1 : 0.7f;
    for (size_t i = 0; i < count_of(&guide); i++)
        guide.data[i] = noise((unsigned)i);
    assert_int_equal(img_guided_upsample(&low, NULL, &guide, NULL, 2, 1e-3f, &out), OK);
    assert_int_equal(out.width, 61);
    assert_int_equal(out.height, 50);
    for (size_t i = 0; i < count_of(&out); i++)
        assert_true(fabsf(out.data[i] - (i % 2 ? -1 : 0.7f)) < 1e-4f);
    img_free(&out);
    img_free(&low);
    img_free(&guide);
}

static void guided_upsampling_follows_the_guides_edges(void **state)
{
    (void)state;
    /* an edge at x = 37 of 64, which the map at a quarter of the size has only as a mixed pixel */
    enum { SIZE = 64, EDGE = 37 };
    img fine = make(SIZE, SIZE, 1), low, out, plain;
    for (int i = 0; i < SIZE * SIZE; i++)
        fine.data[i] = i % SIZE < EDGE ? 0.2f : 0.9f;
    assert_int_equal(img_resize(&fine, SIZE / 4, SIZE / 4, &low), OK);
    assert_int_equal(img_guided_upsample(&low, NULL, &fine, NULL, 2, 1e-4f, &out), OK);
    assert_int_equal(img_resize(&low, SIZE, SIZE, &plain), OK);
    float worst = 0, worst_plain = 0;
    for (int i = 0; i < SIZE * SIZE; i++) {
        worst = fmaxf(worst, fabsf(out.data[i] - fine.data[i]));
        worst_plain = fmaxf(worst_plain, fabsf(plain.data[i] - fine.data[i]));
    }
    /* the map is a linear function of the guide, so that the only error is epsilon's: 1e-4 beside an edge's variance of
     * 0.1 in windows over it, while flat windows tend to their own mean */
    assert_true(worst < 0.02f);
    assert_true(worst_plain > 0.2f);
    img_free(&fine);
    img_free(&low);
    img_free(&out);
    img_free(&plain);
}

static void nothing_leaks_through_the_mask(void **state)
{
    (void)state;
    /* outside the mask both map and guide hold extreme values */
    enum { SIZE = 64, LOW = 16 };
    img low = make(LOW, LOW, 1), low_mask = make(LOW, LOW, 1), guide = make(SIZE, SIZE, 3), mask = make(SIZE, SIZE, 1);
    img out;
    for (int i = 0; i < LOW * LOW; i++) {
        low_mask.data[i] = i % LOW < 8;
        low.data[i] = i % LOW < 8 ? 0.5f : NAN;
    }
    for (int i = 0; i < SIZE * SIZE; i++) {
        mask.data[i] = i % SIZE < 34; /* extends a little beyond the low mask, as a finer outline does */
        for (int c = 0; c < 3; c++)
            guide.data[3 * i + c] = i % SIZE < 34 ? noise((unsigned)i) : 50;
    }
    assert_int_equal(img_guided_upsample(&low, &low_mask, &guide, &mask, 2, 1e-3f, &out), OK);
    for (int i = 0; i < SIZE * SIZE; i++) {
        if (mask.data[i] > 0)
            assert_true(fabsf(out.data[i] - 0.5f) < 1e-4f);
        else
            assert_true(out.data[i] == 0);
    }
    img_free(&out);
    /* far from the map's pixels, its mean is the result */
    memset(low_mask.data, 0, count_of(&low_mask) * sizeof(float));
    low_mask.data[0] = 1;
    assert_int_equal(img_guided_upsample(&low, &low_mask, &guide, &mask, 1, 1e-3f, &out), OK);
    assert_true(fabsf(img_at(&out, 30, 60)[0] - 0.5f) < 1e-4f);
    img_free(&out);
    img_free(&low);
    img_free(&low_mask);
    img_free(&guide);
    img_free(&mask);
}

static void guided_upsampling_refuses_sizes_that_do_not_fit(void **state)
{
    (void)state;
    img low = make(4, 4, 1), guide = make(8, 8, 3), wrong = make(5, 4, 1), out;
    assert_int_equal(img_guided_upsample(&low, &wrong, &guide, NULL, 1, 1e-3f, &out), MERLIN_WRONG_USE);
    assert_int_equal(img_guided_upsample(&low, NULL, &guide, &wrong, 1, 1e-3f, &out), MERLIN_WRONG_USE);
    assert_int_equal(img_guided_upsample(&low, NULL, &guide, NULL, 0, 1e-3f, &out), MERLIN_WRONG_USE);
    assert_int_equal(img_guided_upsample(&low, NULL, &guide, NULL, 1, 0, &out), MERLIN_WRONG_USE);
    assert_null(out.data);
    img_free(&low);
    img_free(&guide);
    img_free(&wrong);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sizes_that_cannot_be_are_refused),
        cmocka_unit_test(shrinking_keeps_the_mean),
        cmocka_unit_test(constants_stay_constant_at_any_size),
        cmocka_unit_test(enlarging_follows_a_smooth_wave),
        cmocka_unit_test(under_a_cover_enlarging_is_the_same_and_beside_it_zero),
        cmocka_unit_test(crop_beyond_the_edges_is_zero_there),
        cmocka_unit_test(guided_upsampling_keeps_constants),
        cmocka_unit_test(guided_upsampling_follows_the_guides_edges),
        cmocka_unit_test(nothing_leaks_through_the_mask),
        cmocka_unit_test(guided_upsampling_refuses_sizes_that_do_not_fit),
    };
    return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
