/* SPDX-License-Identifier: MIT */
/* merlin_maps_from_capture of include/merlin/surface.h, by a model of random weights: what it takes, says and refuses.
 * Its results with weights that ship are tested in Python and by the command. */
#include "../estimate/weights.h"
#include "scratch.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "base/status.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

#include "base/file.h"
#include "merlin/surface.h"
#include "relief.h"

enum { SIZE = 96 };

typedef struct fixture {
    merlin_model *any, *flash;
} fixture;

static int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    if (!f || scratch_open(state) != 0) return -1;
    *state = f;
    const char *any = scratch_path("any.safetensors"), *flash = scratch_path("point.safetensors");
    if (write_random_weights_of("merlin-any", any) != OK || write_random_weights_of("merlin-point", flash) != OK)
        return -1;
    return merlin_model_open(any, &f->any) != OK || merlin_model_open(flash, &f->flash) != OK;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    merlin_model_close(f->any);
    merlin_model_close(f->flash);
    free(f);
    return scratch_close(state);
}

/* Grey or coloured pictures of a sphere. */
static void picture_sphere(int lights, int channels, merlin_capture *c)
{
    const relief sphere = {.size = SIZE, .lights = lights, .channels = channels, .exposure = 1.5f};
    relief_capture(&sphere, c);
    c->lighting = MERLIN_UNKNOWN_LIGHTS;
}

static merlin_params quick(void)
{
    merlin_params p = merlin_params_default();
    p.size = MERLIN_LEAST_SIZE;
    p.views = 1;
    return p;
}

static bool doubts(const merlin_maps *maps, merlin_doubt which)
{
    return (maps->doubts & which) != 0;
}

static void files_are_heeded(void **state)
{
    const fixture *f = *state;
    const merlin_params p = quick();
    merlin_capture c;
    merlin_maps maps;
    merlin_warnings all;
    picture_sphere(3, 1, &c);
    memcpy(c.picture[1].wide, c.picture[0].wide, (size_t)c.width * (size_t)c.height * sizeof(uint16_t));
    warnings_add(&c.noticed, "light_still", "the light is still");
    assert_int_equal(skipped_add(&c.skipped, "a.jxl", "JPEG XL is not read"), OK);
    c.focal_35mm = 85;
    if (merlin_maps_from_capture(f->any, &c, &p, &maps) != MERLIN_OK) fail_msg("%s", merlin_error());
    assert_true(maps.fov > 10 && maps.fov < 25);
    merlin_maps_warnings(&maps, &all);
    assert_non_null(warnings_find(&all, "same_pictures"));
    assert_non_null(warnings_find(&all, "light_still"));
    assert_non_null(warnings_find(&all, "files_skipped"));
    merlin_maps_free(&maps);
    skipped_free(&c.skipped);
    capture_drop(&c);
}

/* A square picture with a diagonal of 43.3 mm is 34 degrees wide, seen from 50 mm away. */
static void the_lens_of_exif_is_as_good_as_a_known_one(void **state)
{
    const fixture *f = *state;
    enum { PICTURES = 8 };
    const double wide = 2 * atan(0.5 * 43.2666 / sqrt(2) / 50) * 180 / 3.14159265358979;
    merlin_params p = quick();
    merlin_maps by_exif, by_params, by_camera;
    merlin_capture c;
    picture_sphere(PICTURES, 1, &c);
    c.focal_35mm = 50;
    if (merlin_maps_from_capture(f->any, &c, &p, &by_exif) != MERLIN_OK) fail_msg("%s", merlin_error());
    c.focal_35mm = 0;
    p.fov = (float)wide;
    if (merlin_maps_from_capture(f->any, &c, &p, &by_params) != MERLIN_OK) fail_msg("%s", merlin_error());
    p.fov = 0;
    pst_capture_see(&c, (float)wide, 0);
    if (merlin_maps_from_capture(f->any, &c, &p, &by_camera) != MERLIN_OK) fail_msg("%s", merlin_error());
    assert_float_equal(by_exif.fov, wide, 1e-3);
    assert_false(doubts(&by_exif, MERLIN_DOUBT_LIGHTS_FAR));
    assert_false(doubts(&by_params, MERLIN_DOUBT_LIGHTS_FAR));
    for (int i = 0; i < 3 * SIZE * SIZE; i++) {
        assert_float_equal(by_params.normal.data[i], by_camera.normal.data[i], 1e-3);
        assert_float_equal(by_exif.normal.data[i], by_camera.normal.data[i], 1e-3);
    }
    merlin_maps_free(&by_exif);
    merlin_maps_free(&by_params);
    merlin_maps_free(&by_camera);
    capture_drop(&c);
}

static void few_pictures_are_the_networks_alone(void **state)
{
    const fixture *f = *state;
    const merlin_params p = quick();
    merlin_capture c;
    merlin_maps maps;
    picture_sphere(3, 1, &c);
    if (merlin_maps_from_capture(f->any, &c, &p, &maps) != MERLIN_OK) fail_msg("%s", merlin_error());
    assert_int_equal(maps.photographs, 3);
    assert_int_equal(maps.refined, 0);
    assert_true(doubts(&maps, MERLIN_DOUBT_NOT_REFINED) && !doubts(&maps, MERLIN_DOUBT_LIGHT_ELSEWHERE));
    char text[300];
    merlin_doubt_message(&maps, MERLIN_DOUBT_NOT_REFINED, text, sizeof text);
    assert_non_null(strstr(text, "fewer than 7 pictures"));
    assert_int_equal(maps.mask_source, MERLIN_MASK_GIVEN);
    merlin_maps_free(&maps);
    capture_drop(&c);
}

/* One picture is what merlin_estimate makes of it. */
static void one_picture_is_a_photograph(void **state)
{
    const fixture *f = *state;
    const merlin_params p = quick();
    merlin_capture c;
    merlin_maps maps, alone;
    merlin_image photo;
    picture_sphere(1, 3, &c);
    assert_int_equal(img_new(&photo, SIZE, SIZE, 3), OK);
    for (int i = 0; i < 3 * SIZE * SIZE; i++)
        photo.data[i] = (float)c.picture[0].wide[i] / 65535;
    assert_int_equal(merlin_maps_from_capture(f->any, &c, &p, &maps), MERLIN_OK);
    assert_int_equal(merlin_estimate(f->any, &photo, &c.mask, &p, &alone), MERLIN_OK);
    assert_memory_equal(maps.normal.data, alone.normal.data, sizeof(float) * 3 * SIZE * SIZE);
    assert_memory_equal(maps.albedo.data, alone.albedo.data, sizeof(float) * 3 * SIZE * SIZE);
    assert_int_equal(maps.doubts, alone.doubts);
    assert_null(maps.spread.data);
    merlin_image_free(&photo);
    merlin_maps_free(&maps);
    merlin_maps_free(&alone);
    capture_drop(&c);
}

/* The spread comes with several pictures, stays in the file, and is a part of its folder. */
static void the_spread_is_kept(void **state)
{
    const fixture *f = *state;
    const merlin_params p = quick();
    merlin_capture c;
    merlin_maps maps, read;
    double sum = 0;
    picture_sphere(5, 3, &c);
    if (merlin_maps_from_capture(f->any, &c, &p, &maps) != MERLIN_OK) fail_msg("%s", merlin_error());
    const char *folder = scratch_path("several");
    if (merlin_maps_write(f->any, &maps, NULL, folder) != MERLIN_OK) fail_msg("%s", merlin_error());
    assert_true(file_exists(scratch_path("several/confidence.png")));
    if (merlin_maps_read(folder, &read) != MERLIN_OK) fail_msg("%s", merlin_error());
    assert_non_null(read.spread.data);
    for (int i = 0; i < SIZE * SIZE; i++) {
        const float spread = maps.spread.data[i];
        assert_true(spread >= 0 && spread <= 90 && (spread == 0 || maps.mask.data[i] > 0));
        assert_float_equal(read.spread.data[i], spread, 1e-3 * (double)spread + 1e-6);
        sum += (double)spread;
    }
    assert_true(sum > 0);
    merlin_maps_free(&maps);
    merlin_maps_free(&read);
    capture_drop(&c);
}

/* Whoever found the lights, the maps are whole: unit normals that the depth agrees with, no reconstruction of others.
 */
static void refined_maps_are_whole(void **state)
{
    const fixture *f = *state;
    const merlin_params p = quick();
    merlin_capture c;
    merlin_maps maps;
    picture_sphere(12, 3, &c);
    assert_int_equal(merlin_maps_from_capture(f->any, &c, &p, &maps), MERLIN_OK);
    assert_true(maps.refined == !doubts(&maps, MERLIN_DOUBT_NOT_REFINED));
    assert_true(maps.refined == doubts(&maps, MERLIN_DOUBT_LIGHTS_FAR)); /* nothing tells the lens */
    assert_null(maps.reconstruction.data);
    for (int i = 0; i < SIZE * SIZE; i++) {
        const float *n = maps.normal.data + 3 * i;
        if (maps.mask.data[i] < 0.5f) continue;
        assert_float_equal(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1, 1e-3);
        assert_true(maps.depth.data[i] > 0.2f && maps.depth.data[i] < 5);
    }
    merlin_maps_free(&maps);
    capture_drop(&c);
}

static int always(void)
{
    return 1;
}

static void what_it_cannot_take_is_refused(void **state)
{
    const fixture *f = *state;
    merlin_params p = quick();
    merlin_capture c;
    merlin_maps maps;
    picture_sphere(3, 3, &c);
    assert_int_equal(merlin_maps_from_capture(f->flash, &c, &p, &maps), MERLIN_WRONG_USE);
    assert_non_null(strstr(merlin_error(), "is for flashes"));
    p.hint.point_count = 1;
    assert_int_equal(merlin_maps_from_capture(f->any, &c, &p, &maps), MERLIN_WRONG_USE);
    assert_non_null(strstr(merlin_error(), "has a mask"));
    p.hint.point_count = 0;
    p.stop = always;
    assert_int_equal(merlin_maps_from_capture(f->any, &c, &p, &maps), MERLIN_STOPPED);
    assert_null(maps.normal.data);
    c.mask.height = SIZE / 2;
    assert_int_equal(merlin_maps_from_capture(f->any, &c, NULL, &maps), MERLIN_BAD_INPUT);
    c.mask.height = SIZE;
    c.count = 0;
    assert_int_equal(merlin_maps_from_capture(f->any, &c, NULL, &maps), MERLIN_WRONG_USE);
    c.count = 3;
    capture_drop(&c);
}

/* bright: number of rows, from the top, that the reader took for the object beside it. */
static void search_beside(const fixture *f, int bright)
{
    const merlin_params p = quick();
    merlin_capture c;
    merlin_maps maps;
    picture_sphere(3, 3, &c);
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < SIZE * SIZE; i++)
            if (c.mask.data[i] == 0) /* a blue wall */
                c.picture[k].wide[3 * i] = 3000, c.picture[k].wide[3 * i + 1] = 5000,
                                      c.picture[k].wide[3 * i + 2] = 30000;
    size_t object = 0, found = 0, both = 0;
    img truth;
    assert_int_equal(img_copy(&truth, &c.mask), OK);
    for (int i = 0; i < bright * SIZE; i++)
        c.mask.data[i] = 1;
    c.mask_found = true;
    assert_int_equal(merlin_maps_from_capture(f->any, &c, &p, &maps), MERLIN_OK);
    assert_int_equal(maps.mask_source, MERLIN_MASK_FOUND);
    for (int i = 0; i < SIZE * SIZE; i++) {
        const bool is = truth.data[i] > 0, was = maps.mask.data[i] >= 0.5f;
        object += is;
        found += was;
        both += is && was;
    }
    assert_true((double)both > 0.9 * (double)(object + found - both));
    img_free(&truth);
    merlin_maps_free(&maps);
    capture_drop(&c);
}

/* The mask that the reader found by brightness counts only where it leaves a background all around. */
static void an_object_is_searched_for_where_all_is_bright(void **state)
{
    search_beside(*state, SIZE);
    search_beside(*state, SIZE / 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_are_heeded),
        cmocka_unit_test(the_lens_of_exif_is_as_good_as_a_known_one),
        cmocka_unit_test(few_pictures_are_the_networks_alone),
        cmocka_unit_test(one_picture_is_a_photograph),
        cmocka_unit_test(the_spread_is_kept),
        cmocka_unit_test(refined_maps_are_whole),
        cmocka_unit_test(what_it_cannot_take_is_refused),
        cmocka_unit_test(an_object_is_searched_for_where_all_is_bright),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
