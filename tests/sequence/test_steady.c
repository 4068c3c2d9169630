/* SPDX-License-Identifier: MIT */
/* Parts of what keeps a sequence's maps steady: alignment, exposure, crop, the followed object, the moving average. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "estimate/object/find_object.h"
#include "sequence/sequence_align.h"
#include "sequence/sequence_blend.h"
#include "sequence/sequence_crop.h"
#include "sequence/sequence_exposure.h"

/* last, as cmocka defines a macro named fail */
#include <cmocka.h>

enum { WIDTH = 200, HEIGHT = 160 };

static float uniform(void)
{
    static uint32_t state = 1;
    state = state * 1664525 + 1013904223;
    return (float)(state >> 8) / (float)(1 << 24);
}

/* Returns the light of a textured disc of radius 40 around (80, 70) before a dark background. */
static float light_at(float x, float y)
{
    const float r = hypotf(x - 80, y - 70);
    return r < 40 ? 0.3f + 0.15f * sinf(0.5f * x) * sinf(0.4f * y + 0.2f * x) : 0.01f;
}

static void make_picture(int dx, int dy, float noise, img *out)
{
    assert_int_equal(img_new(out, WIDTH, HEIGHT, 3), OK);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            for (int c = 0; c < 3; c++)
                img_at(out, x, y)[c] =
                    fmaxf(0, light_at((float)(x - dx), (float)(y - dy)) + noise * (uniform() - 0.5f));
}

static void make_mask(int dx, int dy, float radius, img *out)
{
    assert_int_equal(img_new(out, WIDTH, HEIGHT, 1), OK);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            *img_at(out, x, y) = hypotf((float)(x - dx - 80), (float)(y - dy - 70)) < radius;
}

static void a_shift_is_found_to_the_pixel(void **state)
{
    (void)state;
    static const sequence_shift shifts[] = {{0, 0}, {1, 0}, {7, -4}, {-6, 5}};
    img first, mask, one = {0};
    make_picture(0, 0, 0.02f, &first);
    make_mask(0, 0, 40, &mask);
    assert_int_equal(sequence_grey(&first, 1, &one), OK);
    for (size_t i = 0; i < sizeof shifts / sizeof *shifts; i++) {
        img second, other = {0};
        sequence_shift found;
        make_picture(shifts[i].x, shifts[i].y, 0.02f, &second);
        assert_int_equal(sequence_grey(&second, 1, &other), OK);
        assert_int_equal(sequence_align(&one, &other, &mask, (sequence_shift){0, 0}, &found), OK);
        assert_int_equal(found.x, shifts[i].x);
        assert_int_equal(found.y, shifts[i].y);
        img_free(&second);
        img_free(&other);
    }
    img_free(&first);
    img_free(&mask);
    img_free(&one);
}

static void exposure_and_white_balance_are_found(void **state)
{
    (void)state;
    static const float factor[3] = {0.8f, 1.1f, 1.3f};
    img first, second, mask, one, other;
    float found[3];
    make_picture(0, 0, 0.01f, &first);
    make_picture(0, 0, 0.01f, &second);
    make_mask(0, 0, 38, &mask);
    for (size_t i = 0; i < img_value_count(&second); i++)
        second.data[i] /= factor[i % 3];
    assert_int_equal(sequence_encode(&first, &one), OK);
    assert_int_equal(sequence_encode(&second, &other), OK);
    sequence_factors(&one, &other, &mask, found);
    for (int c = 0; c < 3; c++)
        assert_true(fabsf(found[c] / factor[c] - 1) < 0.01f);
    img_free(&first);
    img_free(&second);
    img_free(&mask);
    img_free(&one);
    img_free(&other);
}

static void what_is_burnt_out_stays_so_and_nothing_becomes_it(void **state)
{
    (void)state;
    float values[12] = {1, 1, 1, 0.9f, 0.5f, 0.2f, 0.96f, 0, 0.7f, 1, 0.1f, 0.3f};
    img photo = {4, 1, 3, values};
    sequence_expose(&photo, (const float[3]){1.3f, 1.3f, 0.7f});
    assert_true(values[0] >= 1 && values[1] >= 1 && values[2] >= 1 && values[9] >= 1);
    assert_true(values[3] < 0.98f && values[6] < 0.98f);
    assert_true(fabsf(values[4] - 0.65f) < 1e-6f && fabsf(values[5] - 0.14f) < 1e-6f && values[7] == 0);
    /* floats above white have no white that is a limit */
    float bright[3] = {3, 0.9f, 0.9f};
    photo = (img){1, 1, 3, bright};
    sequence_expose(&photo, (const float[3]){1.5f, 1.5f, 1});
    assert_true(fabsf(bright[0] - 4.5f) < 1e-6f && fabsf(bright[1] - 1.35f) < 1e-6f);
}

static void next_crop(sequence_crop *c, int dx, int dy, float radius, sequence_shift shift)
{
    img mask;
    make_mask(dx, dy, radius, &mask);
    assert_int_equal(sequence_crop_next(c, &mask, shift, 0.125f), OK);
    assert_true(crop_holds(&mask, c->held, 0, 0));
    img_free(&mask);
}

static void a_crop_moves_with_the_object_and_not_with_its_outline(void **state)
{
    (void)state;
    sequence_crop c = {.begun = false};
    next_crop(&c, 0, 0, 40, (sequence_shift){0, 0});
    const crop_square first = c.held;
    for (int i = 0; i < 10; i++) {
        next_crop(&c, i % 2, 0, 40 + 0.5f * (float)(i % 3), (sequence_shift){0, 0});
        assert_memory_equal(&c.held, &first, sizeof first);
    }
    for (int i = 1; i <= 10; i++)
        next_crop(&c, 3 * i, i, 40, (sequence_shift){3, 1});
    assert_int_equal(c.held.x, first.x + 30);
    assert_int_equal(c.held.y, first.y + 10);
    assert_int_equal(c.held.side, first.side);
    next_crop(&c, 30, 10, 66, (sequence_shift){0, 0}); /* an object that outgrows it */
    assert_true(c.held.side > first.side);
}

static void an_object_is_followed_beside_another(void **state)
{
    (void)state;
    img photo, before, mask, mirrored;
    float overlap;
    make_picture(-35, 5, 0.01f, &photo);
    make_picture(65, 5, 0.01f, &mirrored);
    for (size_t i = 0; i < img_value_count(&photo); i++)
        photo.data[i] = fmaxf(photo.data[i], mirrored.data[i]);
    for (int k = 0; k < 2; k++) {
        const int dx = k ? 65 : -35;
        make_mask(dx + 2, 5, 40, &before);
        assert_int_equal(find_object_again(&photo, &before, &mask, &overlap), OK);
        assert_true(overlap > 0.8f);
        assert_true(*img_at(&mask, 80 + dx, 75) > 0.9f);
        assert_true(*img_at(&mask, 80 + (k ? -35 : 65), 75) < 0.1f);
        img_free(&before);
        img_free(&mask);
    }
    img_free(&photo);
    img_free(&mirrored);
}

static void a_part_that_was_dark_belongs_to_the_object_again(void **state)
{
    (void)state;
    img photo, before, mask;
    float overlap;
    make_picture(0, 0, 0.01f, &photo);
    make_mask(0, 0, 40, &before);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 100; x < WIDTH; x++)
            *img_at(&before, x, y) = 0;
    assert_int_equal(find_object_again(&photo, &before, &mask, &overlap), OK);
    assert_true(*img_at(&mask, 80, 70) > 0.9f);
    assert_true(*img_at(&mask, 112, 70) > 0.9f);
    assert_true(*img_at(&mask, 128, 70) < 0.1f);
    img_free(&photo);
    img_free(&before);
    img_free(&mask);
}

/* Makes maps of a constant albedo within the disc. */
static void make_maps(float albedo, merlin_maps *maps)
{
    *maps = (merlin_maps){.size = 0};
    make_mask(0, 0, 40, &maps->mask);
    assert_int_equal(img_new(&maps->albedo, WIDTH, HEIGHT, 3), OK);
    assert_int_equal(img_new(&maps->normal, WIDTH, HEIGHT, 3), OK);
    assert_int_equal(img_new(&maps->reconstruction, WIDTH, HEIGHT, 3), OK);
    assert_int_equal(img_new(&maps->photo, WIDTH, HEIGHT, 3), OK);
    assert_int_equal(img_new(&maps->roughness, WIDTH, HEIGHT, 1), OK);
    assert_int_equal(img_new(&maps->depth, WIDTH, HEIGHT, 1), OK);
    for (size_t i = 0; i < img_value_count(&maps->mask); i++) {
        if (maps->mask.data[i] == 0) continue;
        for (size_t c = 0; c < 3; c++)
            maps->albedo.data[3 * i + c] = albedo;
        maps->normal.data[3 * i + 2] = 1;
        maps->roughness.data[i] = albedo;
        maps->depth.data[i] = 1;
    }
}

static void maps_are_averaged_where_nothing_moved_and_only_there(void **state)
{
    (void)state;
    enum { MOVED_X = 70, STILL_X = 95, Y = 70 };
    sequence_history h = {.unit = 1};
    float kept, difference;
    for (int i = 0; i < 12; i++) {
        const bool last = i == 11;
        img photo, now, same = {0};
        merlin_maps maps;
        make_picture(0, 0, 0.02f, &photo);
        for (int y = 55; y < 85 && last; y++) /* something dark passes */
            for (int x = 55; x < 85; x++)
                for (int c = 0; c < 3; c++)
                    img_at(&photo, x, y)[c] = 0.02f;
        make_maps(i % 2 ? 0.6f : 0.4f, &maps);
        assert_int_equal(sequence_encode(&photo, &now), OK);
        if (i > 0) assert_int_equal(sequence_sameness(&h, &now, &same, &difference), OK);
        assert_int_equal(sequence_blend(&h, &now, i ? &same : NULL, 8, false, &maps, &kept), OK);
        if (last) {
            assert_true(fabsf(img_at(&maps.albedo, STILL_X, Y)[0] - 0.5f) < 0.04f);
            assert_true(fabsf(*img_at(&maps.roughness, STILL_X, Y) - 0.5f) < 0.04f);
            assert_true(fabsf(img_at(&maps.albedo, MOVED_X, Y)[0] - 0.6f) < 1e-6f);
            assert_true(fabsf(*img_at(&maps.roughness, MOVED_X, Y) - 0.6f) < 1e-6f);
            assert_true(img_at(&maps.albedo, 5, 5)[0] == 0);
            assert_true(kept > 0.5f && kept < 0.9f);
        }
        merlin_maps_free(&maps);
        img_free(&photo);
        img_free(&now);
        img_free(&same);
    }
    sequence_history_free(&h);
}

static void what_is_the_same_where_nearly_all_changed_is_not_averaged(void **state)
{
    (void)state;
    sequence_history h = {.unit = 1};
    img first, second, now, then, same;
    merlin_maps maps;
    float kept, difference;
    make_picture(0, 0, 0.01f, &first);
    make_picture(0, 0, 0.01f, &second);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 50; x < WIDTH; x++) /* all but the left edge of the disc */
            for (int c = 0; c < 3; c++)
                img_at(&second, x, y)[c] *= 1.6f;
    assert_int_equal(sequence_encode(&first, &then), OK);
    assert_int_equal(sequence_encode(&second, &now), OK);
    make_maps(0.5f, &maps);
    assert_int_equal(sequence_blend(&h, &then, NULL, 8, false, &maps, &kept), OK);
    assert_int_equal(sequence_sameness(&h, &now, &same, &difference), OK);
    assert_true(*img_at(&same, 44, 70) == 0 && *img_at(&same, 90, 70) == 0);
    assert_true(difference > 0.05f);
    merlin_maps_free(&maps);
    sequence_history_free(&h);
    img *images[] = {&first, &second, &now, &then, &same};
    for (size_t i = 0; i < 5; i++)
        img_free(images[i]);
}

static void a_patch_that_flickers_into_the_mask_is_not_shown(void **state)
{
    (void)state;
    enum { X = 150, Y = 30 };
    sequence_history h = {.unit = 1};
    float kept, difference;
    for (int i = 0; i < 12; i++) {
        img photo, now, same = {0};
        merlin_maps maps;
        make_picture(0, 0, 0.01f, &photo);
        make_maps(0.5f, &maps);
        if (i == 4 || i > 7) *img_at(&maps.mask, X, Y) = 1; /* once, and then for good */
        assert_int_equal(sequence_encode(&photo, &now), OK);
        if (i > 0) assert_int_equal(sequence_sameness(&h, &now, &same, &difference), OK);
        assert_int_equal(sequence_blend(&h, &now, i ? &same : NULL, 8, false, &maps, &kept), OK);
        if (i < 8) assert_true(*img_at(&maps.mask, X, Y) < 0.1f);
        if (i == 11) assert_true(*img_at(&maps.mask, X, Y) > 0.3f);
        assert_true(*img_at(&maps.mask, 80, 70) == 1);
        merlin_maps_free(&maps);
        img_free(&photo);
        img_free(&now);
        img_free(&same);
    }
    sequence_history_free(&h);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_shift_is_found_to_the_pixel),
        cmocka_unit_test(exposure_and_white_balance_are_found),
        cmocka_unit_test(what_is_burnt_out_stays_so_and_nothing_becomes_it),
        cmocka_unit_test(a_crop_moves_with_the_object_and_not_with_its_outline),
        cmocka_unit_test(an_object_is_followed_beside_another),
        cmocka_unit_test(a_part_that_was_dark_belongs_to_the_object_again),
        cmocka_unit_test(what_is_the_same_where_nearly_all_changed_is_not_averaged),
        cmocka_unit_test(maps_are_averaged_where_nothing_moved_and_only_there),
        cmocka_unit_test(a_patch_that_flickers_into_the_mask_is_not_shown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
