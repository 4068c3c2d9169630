/* SPDX-License-Identifier: MIT */
/* Photographs in surroundings: models of both lights from estimate to relight, with random weights. */
#include "image/image.h"
#include "image/write/write.h"
#include "merlin/merlin.h"
#include "scratch.h"
#include "weights.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

enum { SIDE = 64 };

typedef struct fixture {
    char *folder, weights[96], point_weights[96], output[96], surroundings[96];
    merlin_model *model, *point;
    merlin_image photo, mask;
    merlin_maps maps;
} fixture;

static merlin_image image_new(int channels)
{
    return (merlin_image){SIDE, SIDE, channels, calloc((size_t)(SIDE * SIDE * channels), sizeof(float))};
}

/* A disc before black. */
static void draw(fixture *f)
{
    f->photo = image_new(3);
    f->mask = image_new(1);
    for (int i = 0; i < SIDE * SIDE; i++) {
        float x = ((float)(i % SIDE) - 32) / 28, y = ((float)(i / SIDE) - 32) / 28, d = x * x + y * y;
        if (d >= 1) continue;
        f->mask.data[i] = 1;
        for (int c = 0; c < 3; c++)
            f->photo.data[3 * i + c] = (0.3f + 0.2f * (float)c) * sqrtf(1 - d);
    }
}

/* Bright on the right, dark on the left. */
static status write_surroundings(const char *path)
{
    img map = {0};
    status s = img_new(&map, 32, 16, 3);
    for (int i = 0; s == OK && i < 32 * 16 * 3; i++)
        map.data[i] = i / 3 % 32 >= 16 ? 0.9f : 0.05f;
    if (s == OK) s = img_write_png(path, &map, IMG_LINEAR8);
    img_free(&map);
    return s;
}

static int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    *state = f;
    f->folder = scratch_new();
    snprintf(f->weights, sizeof f->weights, "%s/both.safetensors", f->folder);
    snprintf(f->point_weights, sizeof f->point_weights, "%s/point.safetensors", f->folder);
    snprintf(f->output, sizeof f->output, "%s/out", f->folder);
    snprintf(f->surroundings, sizeof f->surroundings, "%s/room.png", f->folder);
    draw(f);
    if (write_random_weights_of("merlin-env-deep", f->weights) != OK || write_random_weights(f->point_weights) != OK ||
        write_surroundings(f->surroundings) != OK || merlin_model_open(f->weights, &f->model) != MERLIN_OK ||
        merlin_model_open(f->point_weights, &f->point) != MERLIN_OK)
        return -1;
    merlin_params p = merlin_params_default();
    p.size = SIDE;
    return merlin_estimate(f->model, &f->photo, &f->mask, &p, &f->maps) == MERLIN_OK ? 0 : -1;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    merlin_maps_free(&f->maps);
    merlin_model_close(f->model);
    merlin_model_close(f->point);
    merlin_image_free(&f->photo);
    merlin_image_free(&f->mask);
    scratch_remove(f->folder);
    free(f);
    return 0;
}

static void photographs_environment_is_estimated_and_kept(void **state)
{
    fixture *f = *state;
    merlin_maps again;
    float largest = 0;
    assert_true(f->maps.has_environment);
    for (int i = 0; i < 27; i++)
        largest = fmaxf(largest, fabsf(f->maps.environment[i / 3][i % 3]));
    assert_true(largest > 1e-3f && isfinite(largest));
    assert_int_equal(merlin_maps_write(f->model, &f->maps, NULL, f->output), MERLIN_OK);
    assert_int_equal(merlin_maps_read(f->output, &again), MERLIN_OK);
    assert_true(again.has_environment);
    assert_memory_equal(again.environment, f->maps.environment, sizeof again.environment);
    merlin_maps_free(&again);
}

static void point_models_know_no_environment(void **state)
{
    fixture *f = *state;
    merlin_maps maps;
    merlin_params p = merlin_params_default();
    p.size = SIDE;
    assert_int_equal(merlin_estimate(f->point, &f->photo, &f->mask, &p, &maps), MERLIN_OK);
    assert_false(maps.has_environment);
    assert_true(maps.environment[0][0] == 0);
    merlin_maps_free(&maps);
}

static double difference(const merlin_image *a, const merlin_image *b)
{
    double sum = 0;
    for (int i = 0; i < 3 * SIDE * SIDE; i++)
        sum += fabs((double)(a->data[i] - b->data[i]));
    return sum;
}

static void any_model_relights_by_surroundings_which_turn(void **state)
{
    fixture *f = *state;
    const float light[3] = {0.3f, 0.5f, -0.3f};
    merlin_model *models[] = {f->model, f->point};
    merlin_environment *room, *turned;
    assert_int_equal(merlin_environment_read(f->surroundings, 0, 0, &room), MERLIN_OK);
    assert_int_equal(merlin_environment_read(f->surroundings, 180, 0, &turned), MERLIN_OK);
    for (int i = 0; i < 2; i++) {
        merlin_image alone, other, both;
        assert_int_equal(merlin_relight_environment(models[i], &f->maps, room, NULL, MERLIN_BY_BRDF, &alone),
                         MERLIN_OK);
        assert_int_equal(merlin_relight_environment(models[i], &f->maps, turned, NULL, MERLIN_BY_BRDF, &other),
                         MERLIN_OK);
        assert_int_equal(merlin_relight_environment(models[i], &f->maps, room, light, MERLIN_BY_BRDF, &both),
                         MERLIN_OK);
        assert_true(difference(&alone, &other) > 1);
        double brighter = 0;
        for (int k = 0; k < 3 * SIDE * SIDE; k++) {
            assert_true(alone.data[k] >= 0 && alone.data[k] <= 1);
            if (f->mask.data[k / 3] == 0) assert_true(alone.data[k] == 0);
            brighter += (double)(both.data[k] - alone.data[k]);
        }
        assert_true(brighter > 1);
        merlin_image_free(&alone);
        merlin_image_free(&other);
        merlin_image_free(&both);
    }
    merlin_environment_free(room);
    merlin_environment_free(turned);
}

static void relighting_decoder_takes_both_lights_if_it_learned_them(void **state)
{
    fixture *f = *state;
    const float light[3] = {0.3f, 0.5f, -0.3f};
    merlin_environment *room;
    merlin_image image;
    assert_int_equal(merlin_environment_read(f->surroundings, 0, 0, &room), MERLIN_OK);
    assert_int_equal(merlin_relight_environment(f->model, &f->maps, room, light, MERLIN_BY_NETWORK, &image), MERLIN_OK);
    merlin_image_free(&image);
    assert_int_equal(merlin_relight_environment(f->model, &f->maps, room, NULL, MERLIN_BY_NETWORK, &image),
                     MERLIN_WRONG_USE);
    assert_non_null(strstr(merlin_error(), "point light"));
    assert_int_equal(merlin_relight_environment(f->point, &f->maps, room, light, MERLIN_BY_NETWORK, &image),
                     MERLIN_WRONG_USE);
    assert_non_null(strstr(merlin_error(), "point lights only"));
    assert_null(image.data);
    merlin_environment_free(room);
}

/* The square of a picture in the photograph's frame. */
static void assert_shows_the_square(const fixture *f, const merlin_image *square, const merlin_image *whole)
{
    int side = f->maps.crop.side;
    assert_int_equal(square->width, side);
    assert_int_equal(square->height, side);
    for (int y = 0; y < SIDE; y++) {
        for (int x = 0; x < SIDE; x++) {
            int u = x - f->maps.crop.x, v = y - f->maps.crop.y;
            if (u < 0 || v < 0 || u >= side || v >= side || f->mask.data[y * SIDE + x] == 0) continue;
            assert_memory_equal(whole->data + 3 * (y * SIDE + x), square->data + 3 * (v * side + u), 3 * sizeof(float));
        }
    }
}

static void stage_serves_many_lights(void **state)
{
    fixture *f = *state;
    const float lights[3][3] = {{0.3f, 0.5f, -0.3f}, {-0.6f, 0, -0.4f}, {0.3f, 0.5f, -0.3f}};
    const merlin_relighting ways[] = {MERLIN_BY_BRDF, MERLIN_BY_NETWORK, MERLIN_BY_BRDF_UNSHADOWED,
                                      MERLIN_BY_BRDF_DIRECT};
    merlin_environment *room;
    assert_int_equal(merlin_environment_read(f->surroundings, 0, 0, &room), MERLIN_OK);
    for (int w = 0; w < 4; w++) {
        merlin_relighter *relighter;
        assert_int_equal(merlin_relighter_new(f->model, &f->maps, 0, ways[w], &relighter), MERLIN_OK);
        for (int i = 0; i < 6; i++) { /* in the dark and in the room by turns */
            merlin_image square, whole;
            const merlin_environment *in = i % 2 ? room : NULL;
            const float *light = lights[i / 2];
            assert_int_equal(merlin_relighter_render(relighter, light, in, &square), MERLIN_OK);
            assert_int_equal(in ? merlin_relight_environment(f->model, &f->maps, in, light, ways[w], &whole)
                                : merlin_relight(f->model, &f->maps, light, ways[w], &whole),
                             MERLIN_OK);
            assert_shows_the_square(f, &square, &whole);
            merlin_image_free(&square);
            merlin_image_free(&whole);
        }
        merlin_relighter_free(relighter);
    }
    merlin_environment_free(room);
}

static void stage_outlives_its_maps_at_any_side(void **state)
{
    fixture *f = *state;
    const float light[3] = {0.3f, 0.5f, -0.3f};
    merlin_maps maps;
    merlin_relighter *relighter;
    merlin_image square;
    merlin_params p = merlin_params_default();
    p.size = SIDE;
    assert_int_equal(merlin_estimate(f->model, &f->photo, &f->mask, &p, &maps), MERLIN_OK);
    assert_int_equal(merlin_relighter_new(f->model, &maps, 40, MERLIN_BY_BRDF, &relighter), MERLIN_OK);
    merlin_maps_free(&maps);
    assert_int_equal(merlin_relighter_render(relighter, light, NULL, &square), MERLIN_OK);
    assert_int_equal(square.width, 40);
    assert_int_equal(square.height, 40);
    assert_true(square.data[3 * (20 * 40 + 20)] > 0);
    merlin_image_free(&square);
    merlin_relighter_free(relighter);
}

static void stage_says_what_it_misses(void **state)
{
    fixture *f = *state;
    const float nowhere[3] = {NAN, 0, 0};
    const merlin_maps empty = {0};
    merlin_environment *room;
    merlin_relighter *relighter;
    merlin_image image;
    assert_int_equal(merlin_environment_read(f->surroundings, 0, 0, &room), MERLIN_OK);
    assert_int_equal(merlin_relighter_new(f->model, &f->maps, -1, MERLIN_BY_BRDF, &relighter), MERLIN_WRONG_USE);
    assert_int_equal(merlin_relighter_new(f->model, &f->maps, 0, (merlin_relighting)7, &relighter), MERLIN_WRONG_USE);
    assert_int_equal(merlin_relighter_new(f->model, &empty, 0, MERLIN_BY_BRDF, &relighter), MERLIN_WRONG_USE);
    assert_int_equal(merlin_relighter_new(f->model, &f->maps, 0, MERLIN_BY_BRDF, NULL), MERLIN_WRONG_USE);
    assert_null(relighter);
    merlin_relighter_free(NULL);
    assert_int_equal(merlin_relighter_new(f->model, &f->maps, 0, MERLIN_BY_NETWORK, &relighter), MERLIN_OK);
    assert_int_equal(merlin_relighter_render(relighter, NULL, NULL, &image), MERLIN_WRONG_USE);
    assert_non_null(strstr(merlin_error(), "neither a light nor an environment"));
    assert_int_equal(merlin_relighter_render(relighter, NULL, room, &image), MERLIN_WRONG_USE);
    assert_non_null(strstr(merlin_error(), "point light"));
    assert_int_equal(merlin_relighter_render(relighter, nowhere, NULL, &image), MERLIN_WRONG_USE);
    assert_null(image.data);
    merlin_relighter_free(relighter);
    merlin_environment_free(room);
}

static void surroundings_without_light_are_refused(void **state)
{
    fixture *f = *state;
    char path[96];
    img map = {0};
    merlin_environment *room;
    snprintf(path, sizeof path, "%s/black.png", f->folder);
    assert_int_equal(img_new(&map, 32, 16, 3), OK);
    assert_int_equal(img_write_png(path, &map, IMG_LINEAR8), OK);
    img_free(&map);
    assert_int_equal(merlin_environment_read(path, 0, 0, &room), MERLIN_BAD_INPUT);
    assert_non_null(strstr(merlin_error(), "black"));
    assert_null(room);
    assert_int_equal(merlin_environment_read(f->weights, 0, 0, &room), MERLIN_BAD_INPUT);
    assert_int_equal(merlin_environment_read(f->surroundings, NAN, 0, &room), MERLIN_WRONG_USE);
}

/* A Radiance HDR of 32 x 16, bright on the right and dark on the left, all with this exponent. */
static void write_radiance(const char *path, unsigned char exponent)
{
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    fputs("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16 +X 32\n", f);
    for (int i = 0; i < 16 * 32; i++) {
        const unsigned char bright = i % 32 >= 16 ? 250 : 14;
        fwrite((const unsigned char[]){bright, bright, bright, exponent}, 1, 4, f);
    }
    assert_int_equal(fclose(f), 0);
}

/* The largest and the smallest powers of two that leave every value a float of full precision. */
static void surroundings_are_the_same_in_every_unit(void **state)
{
    fixture *f = *state;
    const unsigned char exponents[] = {128, 255, 10};
    char path[96];
    merlin_image images[3];
    snprintf(path, sizeof path, "%s/room.hdr", f->folder);
    for (int k = 0; k < 3; k++) {
        merlin_environment *room;
        write_radiance(path, exponents[k]);
        assert_int_equal(merlin_environment_read(path, 0, 0, &room), MERLIN_OK);
        assert_int_equal(merlin_relight_environment(f->point, &f->maps, room, NULL, MERLIN_BY_BRDF, &images[k]),
                         MERLIN_OK);
        merlin_environment_free(room);
    }
    assert_true(images[0].data[3 * (32 * SIDE + 32)] > 0);
    for (int k = 1; k < 3; k++)
        assert_memory_equal(images[k].data, images[0].data, 3 * SIDE * SIDE * sizeof(float));
    for (int k = 0; k < 3; k++)
        merlin_image_free(&images[k]);
}

/* Somebody's own maps, in the photograph's resolution. */
static void normals_that_are_none_are_relit_as_some(void **state)
{
    fixture *f = *state;
    const float light[3] = {0.5f, 0.3f, -0.4f}, none[] = {NAN, INFINITY, -3e38f, 3e38f};
    merlin_environment *room;
    merlin_image image;
    merlin_maps edited = f->maps;
    edited.normal = image_new(3);
    assert_int_equal(edited.crop.side, SIDE);
    assert_int_equal(merlin_environment_read(f->surroundings, 0, 0, &room), MERLIN_OK);
    for (int k = 0; k < 4; k++) {
        for (int i = 0; i < 3 * SIDE * SIDE; i++)
            edited.normal.data[i] = none[k];
        assert_int_equal(merlin_relight_environment(f->model, &edited, room, light, MERLIN_BY_BRDF, &image), MERLIN_OK);
        for (int i = 0; i < 3 * SIDE * SIDE; i++)
            assert_true(image.data[i] >= 0 && image.data[i] <= 1);
        merlin_image_free(&image);
    }
    merlin_image_free(&edited.normal);
    merlin_environment_free(room);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(photographs_environment_is_estimated_and_kept),
        cmocka_unit_test(point_models_know_no_environment),
        cmocka_unit_test(any_model_relights_by_surroundings_which_turn),
        cmocka_unit_test(relighting_decoder_takes_both_lights_if_it_learned_them),
        cmocka_unit_test(stage_serves_many_lights),
        cmocka_unit_test(stage_outlives_its_maps_at_any_side),
        cmocka_unit_test(stage_says_what_it_misses),
        cmocka_unit_test(surroundings_without_light_are_refused),
        cmocka_unit_test(surroundings_are_the_same_in_every_unit),
        cmocka_unit_test(normals_that_are_none_are_relit_as_some),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
