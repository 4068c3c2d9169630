/* SPDX-License-Identifier: MIT */
/* Which pixels of a capture without a mask are the object. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

#include "base/rng.h"
#include "relief.h"
#include "stereo/capture/capture.h"

enum { SIZE = 64, PICTURES = 8 };

static bool in_disc(int i, float radius)
{
    float x = (float)(i % SIZE) - 31.5f, y = (float)(i / SIZE) - 31.5f;
    return x * x + y * y < radius * radius;
}

/* A disc of this radius whose pictures are of 0.05 to 0.4, before a background; both with noise up to `noise`. */
static void disc_capture(float radius, float background, float noise, merlin_capture *c)
{
    rng r = rng_at(7, 0, 0);
    capture_new(c, SIZE, PICTURES, 3);
    img_free(&c->mask);
    for (int k = 0; k < PICTURES; k++) {
        for (int i = 0; i < SIZE * SIZE * 3; i++) {
            float level = in_disc(i / 3, radius) ? 0.05f * (float)(k + 1) : background;
            c->picture[k].wide[i] = relief_code(fmaxf(level + rng_range(&r, -noise, noise), 0));
        }
    }
}

/* Pixels in which the mask that is found and the disc differ. */
static int differing(float radius, float background, float noise)
{
    merlin_capture c;
    int count = 0;
    disc_capture(radius, background, noise, &c);
    assert_int_equal(pst_capture_find_mask(&c), OK);
    for (int i = 0; i < SIZE * SIZE; i++)
        count += (c.mask.data[i] > 0) != in_disc(i, radius);
    capture_drop(&c);
    return count;
}

static void noise_is_no_object(void **state)
{
    (void)state;
    assert_int_equal(differing(20, 0, 0), 0);
    assert_int_equal(differing(20, 0, 0.01f), 0);
    assert_int_equal(differing(3, 0, 0.01f), 0);
}

static void black_cloth_is_no_object(void **state)
{
    (void)state;
    assert_int_equal(differing(20, 0.006f, 0), 0);
    assert_int_equal(differing(20, 0.008f, 0.008f), 0);
}

/* Nothing is known of what it shows, so that all is the object. */
static void what_is_behind_in_a_lit_room_stays(void **state)
{
    (void)state;
    int outside = 0;
    for (int i = 0; i < SIZE * SIZE; i++)
        outside += !in_disc(i, 20);
    assert_int_equal(differing(20, 0.04f, 0.008f), outside);
}

/* A rim in the noise's upper reaches belongs to the disc, an island as dim beside it does not. */
static void what_is_dim_counts_where_it_hangs_together_with_more(void **state)
{
    (void)state;
    merlin_capture c;
    disc_capture(20, 0.01f, 0.005f, &c);
    const uint16_t dim = relief_code(0.0135f); /* five deviations of the background's root mean square */
    for (int k = 0; k < PICTURES; k++) {
        for (int i = 0; i < SIZE * SIZE; i++) {
            bool rim = in_disc(i, 22) && !in_disc(i, 20),
                 island = i % SIZE < 10 && i % SIZE > 3 && i / SIZE < 10 && i / SIZE > 3;
            for (int ch = 0; ch < 3; ch++)
                if (rim || island) c.picture[k].wide[3 * i + ch] = dim;
        }
    }
    assert_int_equal(pst_capture_find_mask(&c), OK);
    int wrong = 0;
    for (int i = 0; i < SIZE * SIZE; i++)
        wrong += (c.mask.data[i] > 0) != in_disc(i, 22);
    assert_true(wrong <= 2); /* noise, beside the rim; 36 of the island, 272 of the rim */
    capture_drop(&c);
}

/* A pupil and a spark, and a ring's hole and a second object, which are larger. */
static void small_holes_and_specks_are_settled(void **state)
{
    (void)state;
    merlin_capture c;
    disc_capture(20, 0, 0, &c);
    for (int k = 0; k < PICTURES; k++) {
        for (int y = 0; y < 3; y++)
            for (int x = 0; x < 3; x++)
                for (int ch = 0; ch < 3; ch++) {
                    c.picture[k].wide[3 * ((20 + y) * SIZE + 30 + x) + ch] = 0;
                    c.picture[k].wide[3 * ((2 + y) * SIZE + 2 + x) + ch] = 9000;
                }
        for (int y = 0; y < 6; y++)
            for (int x = 0; x < 6; x++)
                for (int ch = 0; ch < 3; ch++) {
                    c.picture[k].wide[3 * ((35 + y) * SIZE + 30 + x) + ch] = 0;
                    c.picture[k].wide[3 * ((56 + y) * SIZE + 2 + x) + ch] = 9000;
                }
    }
    assert_int_equal(pst_capture_find_mask(&c), OK);
    assert_true(*img_at(&c.mask, 31, 21) == 1 && *img_at(&c.mask, 3, 3) == 0);
    assert_true(*img_at(&c.mask, 33, 38) == 0 && *img_at(&c.mask, 5, 59) == 1);
    capture_drop(&c);
}

/* Where not all pixels are looked at for the thresholds, and where there is hardly any edge. */
static void any_size_is_taken(void **state)
{
    (void)state;
    static const int sizes[][2] = {{520, 260}, {1, 40}, {40, 1}, {1, 1}};
    for (size_t n = 0; n < sizeof sizes / sizeof *sizes; n++) {
        int width = sizes[n][0], height = sizes[n][1];
        uint16_t *picture = calloc((size_t)width * (size_t)height, sizeof *picture);
        pst_plane plane = {.wide = picture};
        merlin_capture c = {.width = width, .height = height, .channels = 1, .count = 1, .picture = &plane};
        for (int i = 0; i < width * height; i++) {
            int x = i % width, y = i / width;
            bool inside = 4 * x >= width && 4 * x < 3 * width && 4 * y >= height && 4 * y < 3 * height;
            picture[i] = inside || n > 0 ? 30000 : 300;
        }
        assert_int_equal(pst_capture_find_mask(&c), OK);
        for (int i = 0; i < width * height; i++)
            assert_int_equal(c.mask.data[i] > 0, picture[i] == 30000);
        img_free(&c.mask);
        free(picture);
    }
}

/* To the edge, where a part of it is hardly lit. */
static void an_object_may_fill_the_picture(void **state)
{
    (void)state;
    merlin_capture c;
    disc_capture(100, 0, 0, &c);
    for (int k = 0; k < PICTURES; k++)
        for (int i = 0; i < SIZE * 3; i++)
            c.picture[k].wide[i] = 400;
    assert_int_equal(pst_capture_find_mask(&c), OK);
    for (int i = 0; i < SIZE * SIZE; i++)
        assert_true(c.mask.data[i] == 1);
    capture_drop(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(noise_is_no_object),
        cmocka_unit_test(black_cloth_is_no_object),
        cmocka_unit_test(what_is_behind_in_a_lit_room_stays),
        cmocka_unit_test(what_is_dim_counts_where_it_hangs_together_with_more),
        cmocka_unit_test(small_holes_and_specks_are_settled),
        cmocka_unit_test(any_size_is_taken),
        cmocka_unit_test(an_object_may_fill_the_picture),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
