/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "lab/eval/tables/mask_table.h"
#include "sphere.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

static const sphere ball = {{0, 0, -1}, 0.3f, {0.6f, 0.4f, 0.2f}, 0.7f, 96};

/* A disc of light in the dark, its mask, and the mask's upper half. */
static void make_disc(img *photo, img *mask, img *half)
{
    const int side = 96;
    assert_int_equal(img_new(photo, side, side, 3), OK);
    assert_int_equal(img_new(mask, side, side, 1), OK);
    assert_int_equal(img_new(half, side, side, 1), OK);
    for (int i = 0; i < side * side; i++) {
        int x = i % side - side / 2, y = i / side - side / 2;
        mask->data[i] = x * x + y * y < 28 * 28;
        half->data[i] = mask->data[i] > 0 && y < 0;
        for (int c = 0; c < 3; c++)
            photo->data[3 * i + c] = mask->data[i] > 0 ? 0.5f : 0.005f;
    }
}

static void overlaps_are_those_with_the_known_mask(void **state)
{
    (void)state;
    img photo, mask, half, other;
    mask_table t = {0};
    mask_counts c;
    make_disc(&photo, &mask, &half);
    assert_int_equal(img_new(&other, 95, 96, 1), OK);
    const mask_truth whole = {"whole", MASK_PHOTO, &photo, &mask, NULL},
                     upper = {"upper", MASK_PHOTO, &photo, &half, NULL};
    const mask_truth wrong = {"wrong", MASK_PHOTO, &photo, &other, NULL};
    assert_int_equal(mask_table_add(&t, &whole), OK);
    assert_int_equal(mask_table_add(&t, &upper), OK);
    assert_int_equal(mask_table_add(&t, &wrong), MERLIN_BAD_INPUT);
    assert_int_equal(t.count, 2);
    assert_true(t.row[0].iou > 0.98);
    assert_true(fabs(t.row[1].iou - 0.5) < 0.02);
    assert_int_equal(mask_table_count(&t, MASK_PHOTO, -1, 2, &c), OK);
    assert_int_equal(c.pictures, 2);
    assert_int_equal(c.right, 1);
    assert_int_equal(mask_table_count(&t, COMPOSITE_ROOM, -1, 2, &c), OK);
    assert_int_equal(c.pictures, 0);
    mask_table_free(&t);
    img_free(&photo);
    img_free(&mask);
    img_free(&half);
    img_free(&other);
}

static void nothing_found_overlaps_nothing(void **state)
{
    (void)state;
    img photo, mask, half;
    mask_table t = {0};
    make_disc(&photo, &mask, &half);
    memset(photo.data, 0, img_value_count(&photo) * sizeof *photo.data);
    const mask_truth black = {"black", MASK_PHOTO, &photo, &mask, NULL};
    assert_int_equal(mask_table_add(&t, &black), OK);
    assert_false(t.row[0].found);
    assert_true(t.row[0].iou == 0 && t.row[0].confidence == 0);
    mask_table_free(&t);
    img_free(&photo);
    img_free(&mask);
    img_free(&half);
}

static void composites_show_the_sample_and_are_the_same_again(void **state)
{
    (void)state;
    sample s;
    assert_int_equal(sphere_sample(&ball, 0, &s), OK);
    for (int kind = 0; kind < COMPOSITE_KINDS; kind++) {
        composite one, again, other;
        assert_int_equal(composite_make(&s, 1, (composite_kind)kind, &one), OK);
        assert_int_equal(composite_make(&s, 1, (composite_kind)kind, &again), OK);
        assert_int_equal(composite_make(&s, 2, (composite_kind)kind, &other), OK);
        size_t size = img_value_count(&one.photo) * sizeof(float);
        assert_memory_equal(one.photo.data, again.photo.data, size);
        assert_memory_not_equal(one.photo.data, other.photo.data, size);
        double covered = 0, before = 0;
        for (size_t i = 0; i < img_value_count(&s.mask); i++) {
            covered += (double)one.mask.data[i];
            before += (double)s.mask.data[i];
            assert_true(one.photo.data[3 * i] >= 0 && one.photo.data[3 * i] <= 1);
        }
        /* its frame is shown at 0.62 to 1.05 of its size, and up to an eighth of it may be cut off */
        assert_true(covered > 0.33 * before && covered < 1.15 * before);
        composite_free(&one);
        composite_free(&again);
        composite_free(&other);
    }
    sample_free(&s);
}

static void nothing_is_lit_behind_an_object_in_the_dark(void **state)
{
    (void)state;
    sample s;
    composite c;
    double inside = 0, outside = 0, most = 0, pixels = 0;
    assert_int_equal(sphere_sample(&ball, 0, &s), OK);
    assert_int_equal(composite_make(&s, 1, COMPOSITE_DARK, &c), OK);
    for (size_t i = 0; i < img_value_count(&c.mask); i++) {
        double value = (double)c.photo.data[3 * i];
        *(c.mask.data[i] > 0.99f ? &inside : &outside) += c.mask.data[i] > 0.99f || c.mask.data[i] == 0 ? value : 0;
        pixels += c.mask.data[i] > 0.99f;
        if (c.mask.data[i] == 0) most = fmax(most, value);
    }
    assert_true(inside / pixels > 0.2);
    /* a wall of albedo 1.6 five object distances away returns 0.12 of radiance 1; noise comes on top */
    assert_true(outside / ((double)img_value_count(&c.mask) - pixels) < 0.12 && most < 0.2);
    composite_free(&c);
    sample_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(overlaps_are_those_with_the_known_mask),
        cmocka_unit_test(nothing_found_overlaps_nothing),
        cmocka_unit_test(composites_show_the_sample_and_are_the_same_again),
        cmocka_unit_test(nothing_is_lit_behind_an_object_in_the_dark),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
