/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/rng.h"
#include "base/threads.h"
#include "estimate/object/mask.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

enum { SIDE = 200 };

/* A photograph by flash that is painted pixel by pixel: coordinates from the middle, in pixels. */
typedef float (*painter)(int x, int y, bool *object);

/* Pinkish objects before grey; noise of a hundredth. */
static void paint(painter scene, img *photo, img *truth)
{
    assert_int_equal(img_new(photo, SIDE, SIDE, 3), OK);
    assert_int_equal(img_new(truth, SIDE, SIDE, 1), OK);
    for (int i = 0; i < SIDE * SIDE; i++) {
        rng r = rng_at(3, (uint64_t)i, 0);
        bool object = false;
        float value = scene(i % SIDE - SIDE / 2, i / SIDE - SIDE / 2, &object);
        const float tint[] = {1, object ? 0.8f : 1, object ? 0.7f : 0.95f};
        truth->data[i] = object;
        for (int c = 0; c < 3; c++)
            photo->data[3 * i + c] = fmaxf(tint[c] * value * (1 + 0.04f * rng_normal(&r)) + 0.001f * rng_normal(&r), 0);
    }
}

static double overlap(const img *one, const img *other)
{
    size_t both = 0, either = 0;
    for (size_t i = 0; i < img_value_count(one); i++) {
        both += one->data[i] >= 0.5f && other->data[i] >= 0.5f;
        either += one->data[i] >= 0.5f || other->data[i] >= 0.5f;
    }
    return (double)both / (double)either;
}

/* Intersection over union of what is found. */
static double found_in(painter scene, const merlin_hint *hint, float *confidence)
{
    img photo, truth, mask;
    mask_choice choice;
    paint(scene, &photo, &truth);
    assert_int_equal(mask_choose(&photo, NULL, hint, &mask, &choice), OK);
    assert_true(choice.found);
    double iou = overlap(&mask, &truth);
    if (confidence) *confidence = choice.confidence;
    img_free(&photo);
    img_free(&truth);
    img_free(&mask);
    return iou;
}

/* ---- scenes ---- */

/* Darker toward the outline, as under a flash. */
static float ball(int x, int y, int radius)
{
    float square = (float)(x * x + y * y) / (float)(radius * radius);
    return 0.6f * sqrtf(fmaxf(1 - square, 0)) + 0.1f;
}

static float ring(int x, int y, bool *object)
{
    int square = x * x + y * y;
    *object = square < 70 * 70 && square > 32 * 32;
    return *object ? 0.5f : 0.06f + 0.0002f * (float)x;
}

/* Its lower third is nearly as dark as the floor that it stands on. */
static float dark_base(int x, int y, bool *object)
{
    *object = abs(x) < 45 && y > -70 && y < 60;
    if (*object) return y < 15 ? 0.5f : 0.05f;
    return y > 30 ? 0.012f : 0.003f;
}

/* Its foot stands on a desk of stripes that grows darker toward its far end. */
static float on_a_desk(int x, int y, bool *object)
{
    *object = x * x + y * y < 55 * 55;
    if (*object) return ball(x, y, 55);
    if (y < 20) return 0.01f;
    return 0.002f * (float)(y - 15) * (1 + 0.25f * sinf(0.3f * (float)x));
}

static float cut_off_below(int x, int y, bool *object)
{
    *object = x * x + (y - 50) * (y - 50) < 75 * 75;
    return *object ? 0.45f + 0.1f * sinf(0.2f * (float)x) : 0.04f;
}

static float two_balls(int x, int y, bool *object)
{
    bool left = (x + 45) * (x + 45) + y * y < 36 * 36, right = (x - 45) * (x - 45) + y * y < 36 * 36;
    *object = left;
    return left ? ball(x + 45, y, 36) : right ? ball(x - 45, y, 36) : 0.01f;
}

static float nothing(int x, int y, bool *object)
{
    (void)x;
    (void)y;
    *object = false;
    return 0.1f;
}

/* ---- tests ---- */

static void a_ring_keeps_its_hole(void **state)
{
    (void)state;
    assert_true(found_in(ring, NULL, NULL) > 0.98); /* filled: 0.79 */
}

static void a_dark_base_on_a_dark_floor_belongs_to_its_object(void **state)
{
    (void)state;
    float confidence;
    assert_true(found_in(dark_base, NULL, &confidence) > 0.97); /* without: 0.65 */
    assert_true(confidence > 0.5f);
}

static void a_desk_does_not_belong_to_what_stands_on_it(void **state)
{
    (void)state;
    assert_true(found_in(on_a_desk, NULL, NULL) > 0.97);
}

static void an_object_may_be_cut_off_below(void **state)
{
    (void)state;
    assert_true(found_in(cut_off_below, NULL, NULL) > 0.97);
}

static void a_point_chooses_among_objects(void **state)
{
    (void)state;
    assert_true(found_in(two_balls, NULL, NULL) < 0.6);
    const merlin_hint hint = {.point_count = 1, .point = {{.x = 55, .y = 100}}};
    assert_true(found_in(two_balls, &hint, NULL) > 0.97);
}

static void a_box_shuts_out_what_is_beside_it(void **state)
{
    (void)state;
    const merlin_hint hint = {.box = {.x = 15, .y = 60, .width = 80, .height = 80}};
    assert_true(found_in(two_balls, &hint, NULL) > 0.97);
}

static void a_box_may_be_the_whole_photograph(void **state)
{
    (void)state;
    const merlin_hint hint = {.box = {.width = SIDE, .height = SIDE}};
    assert_true(found_in(ring, &hint, NULL) > 0.98);
}

/* Hints count the pixels of a file that was read at a third of its size. */
static void hints_of_a_reduced_photograph_are_its_files(void **state)
{
    (void)state;
    const merlin_hint point = {.point_count = 1, .point = {{.x = 3 * 55 + 1, .y = 3 * 100 + 2}}, .reduced = 3};
    const merlin_hint box = {.box = {.x = 3 * 15, .y = 3 * 60, .width = 3 * 80, .height = 3 * 80}, .reduced = 3};
    assert_true(found_in(two_balls, &point, NULL) > 0.97);
    assert_true(found_in(two_balls, &box, NULL) > 0.97);
}

static void nothing_to_find_is_said(void **state)
{
    (void)state;
    img photo, truth, mask;
    mask_choice choice;
    paint(nothing, &photo, &truth);
    status s = mask_choose(&photo, NULL, NULL, &mask, &choice);
    assert_true(s == MERLIN_BAD_INPUT || choice.confidence < MASK_LITTLE_CONFIDENCE);
    img_free(&photo);
    img_free(&truth);
    img_free(&mask);
}

static void threads_change_nothing(void **state)
{
    (void)state;
    img photo, truth, mask[2];
    mask_choice choice[2];
    paint(on_a_desk, &photo, &truth);
    for (int i = 0; i < 2; i++) {
        threads_use_here(1 + i);
        assert_int_equal(mask_choose(&photo, NULL, NULL, &mask[i], &choice[i]), OK);
    }
    threads_use_here(0);
    assert_memory_equal(mask[0].data, mask[1].data, img_value_count(&truth) * sizeof(float));
    assert_true(choice[0].confidence == choice[1].confidence);
    img_free(&photo);
    img_free(&truth);
    img_free(&mask[0]);
    img_free(&mask[1]);
}

static void is_refused(const merlin_hint *hint, const char *words)
{
    img photo, truth, mask;
    mask_choice choice;
    paint(ring, &photo, &truth);
    assert_int_equal(mask_choose(&photo, NULL, hint, &mask, &choice), MERLIN_WRONG_USE);
    assert_non_null(strstr(status_message(), words));
    assert_null(mask.data);
    img_free(&photo);
    img_free(&truth);
}

static void hints_outside_the_photograph_are_refused(void **state)
{
    (void)state;
    is_refused(&(merlin_hint){.point_count = 1, .point = {{.x = SIDE, .y = 3}}}, "200,3 lies outside the photograph");
    is_refused(&(merlin_hint){.point_count = 1, .point = {{.x = -1, .y = 3}}}, "-1,3 lies outside");
    is_refused(&(merlin_hint){.box = {.x = 150, .y = 0, .width = 51, .height = 20}}, "150,0,51,20 does not lie");
    is_refused(&(merlin_hint){.box = {.x = 1, .y = 1, .width = 5, .height = 2147483647}}, "does not lie");
    is_refused(&(merlin_hint){.box = {.x = 1, .y = 1, .width = 5}}, "does not lie");
    is_refused(&(merlin_hint){.point_count = 17}, "at most 16");
    is_refused(&(merlin_hint){.point_count = 1, .point = {{.x = 2 * SIDE, .y = 3}}, .reduced = 2},
               "400,3 lies outside the photograph of 400×400");
    is_refused(&(merlin_hint){.point_count = 1,
                              .point = {{.x = 3, .y = 3}},
                              .box = {.x = 10, .y = 10, .width = 20, .height = 20}},
               "outside the box");
}

static void hints_beside_a_mask_are_refused(void **state)
{
    (void)state;
    img photo, truth, mask;
    mask_choice choice;
    paint(ring, &photo, &truth);
    const merlin_hint none = {0}, hint = {.point_count = 1};
    assert_int_equal(mask_choose(&photo, &truth, &hint, &mask, &choice), MERLIN_WRONG_USE);
    assert_int_equal(mask_choose(&photo, &truth, &none, &mask, &choice), OK);
    assert_memory_equal(mask.data, truth.data, img_value_count(&truth) * sizeof(float));
    img_free(&photo);
    img_free(&truth);
    img_free(&mask);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ring_keeps_its_hole),
        cmocka_unit_test(a_dark_base_on_a_dark_floor_belongs_to_its_object),
        cmocka_unit_test(a_desk_does_not_belong_to_what_stands_on_it),
        cmocka_unit_test(an_object_may_be_cut_off_below),
        cmocka_unit_test(a_point_chooses_among_objects),
        cmocka_unit_test(a_box_shuts_out_what_is_beside_it),
        cmocka_unit_test(a_box_may_be_the_whole_photograph),
        cmocka_unit_test(hints_of_a_reduced_photograph_are_its_files),
        cmocka_unit_test(nothing_to_find_is_said),
        cmocka_unit_test(threads_change_nothing),
        cmocka_unit_test(hints_outside_the_photograph_are_refused),
        cmocka_unit_test(hints_beside_a_mask_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
