/* SPDX-License-Identifier: MIT */
/* Fine normals from a larger picture: what is taken from it, and when. */
#include "estimate/photo/detail.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "image/resize.h"
#include "merlin/merlin.h"
#include "scratch.h"
#include "weights.h"

static void it_is_as_large_as_is_asked_for_but_not_larger_than_the_crop(void **state)
{
    (void)state;
    assert_int_equal(detail_side(512, 4000), 512);
    assert_int_equal(detail_side(384, 4000), 384);
    assert_int_equal(detail_side(512, 400), 384);
    assert_int_equal(detail_side(512, 287), 0);
    assert_int_equal(detail_side(512, 100), 0);
    assert_int_equal(detail_side(256, 4000), 0);
    assert_int_equal(detail_side(64, 4000), 0);
}

enum { SIDE = 384 };

static void put_unit(img *normal, int x, int y, vec3 n)
{
    n = vec3_normalize(n);
    float *to = img_at(normal, x, y);
    to[0] = n.x, to[1] = n.y, to[2] = n.z;
}

/* Root of the mean squared difference inside the mask. */
static float difference(const img *a, const img *b, const img *mask)
{
    double sum = 0, count = 0;
    for (size_t i = 0; i < img_value_count(a); i++) {
        if (!(mask->data[i / 3] > 0.5f)) continue;
        double d = (double)a->data[i] - (double)b->data[i];
        sum += d * d;
        count++;
    }
    return (float)sqrt(sum / count);
}

/* A dome with ripples eight pixels long; seen small without the ripples, seen large with a tilt that is not there. */
static void what_is_fine_comes_from_the_one_and_what_is_coarse_from_the_other(void **state)
{
    (void)state;
    img mask, truth, small, large, fused;
    assert_int_equal(img_new(&mask, SIDE, SIDE, 1), OK);
    img *normals[] = {&truth, &small, &large};
    for (int i = 0; i < 3; i++)
        assert_int_equal(img_new(normals[i], SIDE, SIDE, 3), OK);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            float u = 2.2f * ((float)x + 0.5f) / SIDE - 1.1f, v = 1.1f - 2.2f * ((float)y + 0.5f) / SIDE;
            if (u * u + v * v > 1) continue;
            float ripple = 0.2f * sinf((float)x * 0.785f), tilt = 0.3f * v;
            *img_at(&mask, x, y) = 1;
            put_unit(&small, x, y, vec3_make(0.5f * u, 0.5f * v, 1));
            put_unit(&truth, x, y, vec3_make(0.5f * u + ripple, 0.5f * v, 1));
            put_unit(&large, x, y, vec3_make(0.5f * u + ripple, 0.5f * v + tilt, 1));
        }
    assert_int_equal(img_copy(&fused, &small), OK);
    assert_int_equal(detail_fuse(&large, &mask, &fused), OK);
    float of_fused = difference(&fused, &truth, &mask);
    assert_true(of_fused < 0.1f * difference(&small, &truth, &mask));
    assert_true(of_fused < 0.15f * difference(&large, &truth, &mask));
    for (int i = 0; i < SIDE * SIDE; i++)
        if (mask.data[i] == 0) assert_true(fused.data[3 * i] == 0 && fused.data[3 * i + 2] == 0);
    img *all[] = {&mask, &truth, &small, &large, &fused};
    for (int i = 0; i < 5; i++)
        img_free(all[i]);
}

/* A bar thinner than half of what coarse and fine are told apart by, as it is seen small; seen large with a tilt. */
static void what_is_thin_has_a_coarse_part_too(void **state)
{
    (void)state;
    enum { LEFT = 3, RIGHT = 9 };
    img mask, small, large, fused;
    assert_int_equal(img_new(&mask, SIDE, SIDE, 1), OK);
    img *normals[] = {&small, &large};
    for (int i = 0; i < 2; i++)
        assert_int_equal(img_new(normals[i], SIDE, SIDE, 3), OK);
    for (int y = 0; y < SIDE; y++)
        for (int x = LEFT; x < RIGHT; x++) {
            *img_at(&mask, x, y) = 1;
            put_unit(&small, x, y, vec3_make(0.2f, 0, 1));
            put_unit(&large, x, y, vec3_make(0.2f, 0.4f, 1));
        }
    assert_int_equal(img_copy(&fused, &small), OK);
    assert_int_equal(detail_fuse(&large, &mask, &fused), OK);
    assert_true(difference(&fused, &small, &mask) < 0.1f * difference(&large, &small, &mask));
    img *all[] = {&mask, &small, &large, &fused};
    for (int i = 0; i < 4; i++)
        img_free(all[i]);
}

/* ---- as merlin_estimate does it, with random weights ---- */

typedef struct fixture {
    char *folder;
    merlin_model *model;
} fixture;

static int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    char weights[128];
    *state = f;
    f->folder = scratch_new();
    snprintf(weights, sizeof weights, "%s/random.safetensors", f->folder);
    if (write_random_weights(weights) != OK) return -1;
    return merlin_model_open(weights, &f->model) == MERLIN_OK ? 0 : -1;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    merlin_model_close(f->model);
    scratch_remove(f->folder);
    free(f);
    return 0;
}

static merlin_image image_new(int side, int channels)
{
    return (merlin_image){side, side, channels, calloc((size_t)(side * side * channels), sizeof(float))};
}

/* A checkered disc in a frame as it is cropped to. */
static void draw(int side, merlin_image *photo, merlin_image *mask)
{
    *photo = image_new(side, 3);
    *mask = image_new(side, 1);
    for (int i = 0; i < side * side; i++) {
        float x = 2.5f * (float)(i % side) / (float)side - 1.25f, y = 2.5f * (float)(i / side) / (float)side - 1.25f;
        mask->data[i] = x * x + y * y < 1;
        float dark = ((i % side) / 3 + (i / side) / 3) % 2 ? 1 : 0.6f;
        for (int c = 0; c < 3; c++)
            photo->data[3 * i + c] = mask->data[i] * dark * (0.3f + 0.2f * (float)c) * (1.1f - x * x - y * y);
    }
}

static void estimate(const fixture *f, int side, int size, merlin_maps *maps)
{
    merlin_image photo, mask;
    draw(side, &photo, &mask);
    merlin_params p = merlin_params_default();
    p.size = size;
    p.views = 1;
    if (merlin_estimate(f->model, &photo, &mask, &p, maps) != MERLIN_OK) fail_msg("%s", merlin_error());
    assert_int_equal(maps->crop.side, side);
    merlin_image_free(&photo);
    merlin_image_free(&mask);
}

static img view_of(const merlin_image *image)
{
    return (img){.width = image->width, .height = image->height, .channels = image->channels, .data = image->data};
}

static void a_photograph_of_the_networks_size_is_seen_as_ever(void **state)
{
    merlin_maps plain, asked;
    estimate(*state, 256, 256, &plain);
    estimate(*state, 256, 512, &asked);
    assert_memory_equal(plain.normal.data, asked.normal.data, 3 * 256 * 256 * sizeof(float));
    assert_memory_equal(plain.depth.data, asked.depth.data, 256 * 256 * sizeof(float));
    merlin_maps_free(&plain);
    merlin_maps_free(&asked);
}

static void of_a_larger_one_normals_get_finer_and_stay_what_they_are_from_afar(void **state)
{
    merlin_maps plain, finer;
    estimate(*state, SIDE, 256, &plain);
    estimate(*state, SIDE, 512, &finer);
    assert_int_equal(plain.size, 256);
    assert_int_equal(finer.size, 256);
    img mask = view_of(&plain.mask), a = view_of(&plain.normal), b = view_of(&finer.normal);
    img far_mask, far_a, far_b;
    assert_int_equal(img_resize(&mask, 12, 12, &far_mask), OK);
    assert_int_equal(img_resize(&a, 12, 12, &far_a), OK);
    assert_int_equal(img_resize(&b, 12, 12, &far_b), OK);
    float near_by = difference(&a, &b, &mask);
    assert_true(near_by > 1e-3f);
    assert_true(difference(&far_a, &far_b, &far_mask) < 0.25f * near_by);
    /* the rest is of the picture of the network's size, brought to another on the way */
    a = view_of(&plain.albedo), b = view_of(&finer.albedo);
    assert_true(difference(&a, &b, &mask) < 0.01f);
    for (int i = 0; i < SIDE * SIDE; i++)
        assert_true(isfinite(finer.depth.data[i]) && (finer.depth.data[i] > 0) == (finer.mask.data[i] > 0));
    img_free(&far_mask);
    img_free(&far_a);
    img_free(&far_b);
    merlin_maps_free(&plain);
    merlin_maps_free(&finer);
}

static int calls_left;

static int stop_later(void)
{
    return calls_left-- == 0;
}

static void it_can_be_stopped_at_every_stage(void **state)
{
    const fixture *f = *state;
    merlin_image photo, mask;
    draw(SIDE, &photo, &mask);
    merlin_params p = merlin_params_default();
    p.stop = stop_later;
    merlin_maps maps;
    merlin_status s = MERLIN_STOPPED;
    int stages = 0;
    for (; s == MERLIN_STOPPED && stages < 100; stages++) {
        calls_left = stages;
        s = merlin_estimate(f->model, &photo, &mask, &p, &maps);
        if (s == MERLIN_STOPPED) assert_null(maps.normal.data);
    }
    assert_int_equal(s, MERLIN_OK);
    /* four views of the one picture, two of the other */
    assert_true(stages > 6);
    merlin_maps_free(&maps);
    merlin_image_free(&photo);
    merlin_image_free(&mask);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_is_as_large_as_is_asked_for_but_not_larger_than_the_crop),
        cmocka_unit_test(what_is_fine_comes_from_the_one_and_what_is_coarse_from_the_other),
        cmocka_unit_test(what_is_thin_has_a_coarse_part_too),
        cmocka_unit_test(a_photograph_of_the_networks_size_is_seen_as_ever),
        cmocka_unit_test(of_a_larger_one_normals_get_finer_and_stay_what_they_are_from_afar),
        cmocka_unit_test(it_can_be_stopped_at_every_stage),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
