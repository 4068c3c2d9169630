/* SPDX-License-Identifier: MIT */
/* The mean over all eight orientations turns with the photograph. */
#include "estimate/photo/network.h"
#include "estimate/photo/view.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "nn/device.h"
#include "optics/orientation.h"
#include "scratch.h"
#include "weights.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { SIZE = 64 };

/* A shaded blob that looks different from every side. */
static void draw(img *photo, img *mask)
{
    assert_int_equal(img_new(photo, SIZE, SIZE, 3), OK);
    assert_int_equal(img_new(mask, SIZE, SIZE, 1), OK);
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++) {
            float u = ((float)x - 28) / 24, v = ((float)y - 34) / 20, inside = 1 - u * u - v * v;
            if (inside <= 0) continue;
            *img_at(mask, x, y) = 1;
            for (int c = 0; c < 3; c++)
                img_at(photo, x, y)[c] = inside * (0.3f + 0.1f * (float)c + 0.2f * u) + (x > 30 && y < 20 ? 0.2f : 0);
        }
}

static void turn(const img *image, int orientation, img *turned)
{
    size_t channels = (size_t)image->channels;
    assert_int_equal(img_new(turned, SIZE, SIZE, image->channels), OK);
    for (size_t i = 0; i < (size_t)SIZE * SIZE; i++)
        memcpy(turned->data + channels * orientation_place(orientation, SIZE, i), image->data + channels * i,
               channels * sizeof(float));
}

static float largest_difference(const img *a, const img *b)
{
    float most = 0;
    for (size_t i = 0, n = (size_t)a->width * (size_t)a->height * (size_t)a->channels; i < n; i++)
        most = fmaxf(most, fabsf(a->data[i] - b->data[i]));
    return most;
}

static void orientations_are_undone_by_their_inverse(void **state)
{
    (void)state;
    for (int o = 0; o < ORIENTATIONS; o++) {
        int back = orientation_inverse(o);
        float v[3] = {0.1f, 0.2f, 0.3f};
        orientation_turn(o, v);
        orientation_turn(back, v);
        assert_float_equal(v[0], 0.1f, 0);
        assert_float_equal(v[1], 0.2f, 0);
        for (size_t i = 0; i < 25; i++)
            assert_int_equal(orientation_place(back, 5, orientation_place(o, 5, i)), i);
    }
}

/* Sums of the same eight numbers in another order: the tolerances are rounding's. */
static void the_mean_over_all_views_turns_with_the_photograph(void **state)
{
    (void)state;
    network *n;
    img photo, mask, turned_photo, turned_mask;
    network_estimation one = {0}, other = {0};
    assert_int_equal(write_random_weights_of("merlin-env-deep", scratch_path("w.safetensors")), OK);
    assert_int_equal(network_open(scratch_path("w.safetensors"), &n), OK);
    draw(&photo, &mask);
    assert_int_equal(network_estimate(n, &photo, &mask, NULL, ORIENTATIONS, NULL, &one), OK);
    for (int o = 1; o < ORIENTATIONS; o += 3) {
        img albedo, normal;
        turn(&photo, o, &turned_photo);
        turn(&mask, o, &turned_mask);
        assert_int_equal(network_estimate(n, &turned_photo, &turned_mask, NULL, ORIENTATIONS, NULL, &other), OK);
        assert_int_equal(img_new(&albedo, SIZE, SIZE, 3), OK);
        assert_int_equal(img_new(&normal, SIZE, SIZE, 3), OK);
        view_add(&albedo, &other.maps.albedo, o, 1);
        view_add_normals(&normal, &other.maps.normal, o, 1);
        assert_true(largest_difference(&albedo, &one.maps.albedo) < 1e-5f);
        assert_true(largest_difference(&normal, &one.maps.normal) < 1e-4f);
        orientation_turn_sh(orientation_inverse(o), other.environment);
        for (int i = 0; i < 27; i++)
            assert_float_equal(other.environment[i / 3][i % 3], one.environment[i / 3][i % 3], 1e-4);
        network_estimation_free(&other);
        img_free(&albedo);
        img_free(&normal);
        img_free(&turned_photo);
        img_free(&turned_mask);
    }
    network_estimation_free(&one);
    img_free(&photo);
    img_free(&mask);
    network_close(n);
}

/* So is what lit it, and where the lens's axis is, of models of any light. */
static void the_light_that_is_found_turns_with_the_photograph(void **state)
{
    (void)state;
    network *n;
    img photo, mask, turned_photo, turned_mask;
    network_estimation one = {0}, other = {0};
    const sight how = {.lens = {35, {0.2f, -0.1f}}};
    assert_int_equal(write_random_weights_of("merlin-any", scratch_path("any.safetensors")), OK);
    assert_int_equal(network_open(scratch_path("any.safetensors"), &n), OK);
    draw(&photo, &mask);
    assert_int_equal(network_estimate(n, &photo, &mask, &how, ORIENTATIONS, NULL, &one), OK);
    for (int o = 1; o < ORIENTATIONS; o += 3) {
        img visibility;
        float slant[3] = {how.lens.slant.right, how.lens.slant.up, 0}, *toward = other.lights + MODEL_LIGHTS_LAMP;
        orientation_turn(o, slant);
        const sight turned = {.lens = {35, {slant[0], slant[1]}}};
        turn(&photo, o, &turned_photo);
        turn(&mask, o, &turned_mask);
        assert_int_equal(network_estimate(n, &turned_photo, &turned_mask, &turned, ORIENTATIONS, NULL, &other), OK);
        orientation_turn(orientation_inverse(o), toward);
        for (int i = 0; i < MODEL_LIGHTS_REST; i++)
            assert_float_equal(other.lights[i], one.lights[i], 1e-4);
        assert_int_equal(img_new(&visibility, SIZE, SIZE, 1), OK);
        view_add(&visibility, &other.visibility, o, 1);
        assert_true(largest_difference(&visibility, &one.visibility) < 1e-5f);
        network_estimation_free(&other);
        img_free(&visibility);
        img_free(&turned_photo);
        img_free(&turned_mask);
    }
    network_estimation_free(&one);
    img_free(&photo);
    img_free(&mask);
    network_close(n);
}

/* The first four views are the flips, any of which makes one of the others of each. */
static void a_relit_picture_is_flipped_with_photograph_and_light(void **state)
{
    (void)state;
    network *n;
    img photo, mask, relit;
    const float environment[9][3] = {{0.8f, 0.7f, 0.6f}, {0.1f, 0.2f, 0.3f}, {-0.2f, 0, 0.1f}, {0.3f, -0.1f, 0.2f}};
    const illumination light = {{0.6f, 0.3f, -0.4f}, environment};
    assert_int_equal(write_random_weights_of("merlin-env-deep", scratch_path("w.safetensors")), OK);
    assert_int_equal(network_open(scratch_path("w.safetensors"), &n), OK);
    draw(&photo, &mask);
    network_features *features;
    assert_int_equal(network_features_new(n, &photo, &mask, NULL, NETWORK_VIEWS, &features), OK);
    assert_int_equal(network_relight(n, features, &light, &relit), OK);
    network_features_free(features);
    for (int o = 1; o < 4; o++) {
        img turned_photo, turned_mask, other, back;
        float place[3] = {light.place.x, light.place.y, light.place.z}, turned_environment[9][3];
        memcpy(turned_environment, environment, sizeof environment);
        orientation_turn(o, place);
        orientation_turn_sh(o, turned_environment);
        const illumination turned = {vec3_of(place), (const float(*)[3])turned_environment};
        turn(&photo, o, &turned_photo);
        turn(&mask, o, &turned_mask);
        assert_int_equal(network_features_new(n, &turned_photo, &turned_mask, NULL, NETWORK_VIEWS, &features), OK);
        assert_int_equal(network_relight(n, features, &light, &other), OK);
        assert_int_equal(img_new(&back, SIZE, SIZE, 3), OK);
        view_add(&back, &other, o, 1);
        assert_true(largest_difference(&back, &relit) > 1e-3f); /* the light stood still */
        img_free(&other);
        assert_int_equal(network_relight(n, features, &turned, &other), OK);
        network_features_free(features);
        memset(back.data, 0, img_value_count(&back) * sizeof *back.data);
        view_add(&back, &other, o, 1);
        assert_true(largest_difference(&back, &relit) < 1e-5f);
        img_free(&turned_photo);
        img_free(&turned_mask);
        img_free(&other);
        img_free(&back);
    }
    img_free(&relit);
    img_free(&photo);
    img_free(&mask);
    network_close(n);
}

/* Albedo is neither smoothed nor fused. */
static void what_the_network_sees_becomes_the_estimate(void **state)
{
    (void)state;
    network *n;
    img photo, mask;
    network_estimation seen, made, brief;
    const sight how = {.lens = {35, {0.2f, -0.1f}}};
    assert_int_equal(write_random_weights(scratch_path("w.safetensors")), OK);
    assert_int_equal(network_open(scratch_path("w.safetensors"), &n), OK);
    draw(&photo, &mask);
    assert_int_equal(network_see(n, &photo, &mask, &how, 2, NULL, &seen), OK);
    assert_int_equal(network_estimate(n, &photo, &mask, &how, 2, NULL, &made), OK);
    assert_float_equal(seen.maps.lens.fov, 35, 0);
    assert_memory_equal(seen.maps.mask.data, mask.data, img_value_count(&mask) * sizeof(float));
    for (size_t i = 0; i < img_value_count(&photo); i++)
        if (mask.data[i / 3] > 0) assert_float_equal(made.maps.albedo.data[i], seen.maps.albedo.data[i], 0);
    assert_true(largest_difference(&seen.maps.normal, &made.maps.normal) > 0);
    const nn_type usual = nn_fastest_type(), other = usual == NN_FLOAT32 ? NN_BFLOAT16 : NN_FLOAT32;
    network_compute_in(n, other);
    assert_int_equal(network_see(n, &photo, &mask, &how, 2, NULL, &brief), OK);
    float apart = largest_difference(&seen.maps.albedo, &brief.maps.albedo);
    const bool in_both = cpu_device()->usable_type(other) == other; /* else float32 was computed twice */
    assert_true((apart > 0) == in_both && apart < 0.05f);           /* bfloat16 keeps eight bits */
    network_estimation_free(&brief);
    network_compute_in(n, usual);
    assert_int_equal(network_see(n, &photo, &mask, &how, 2, NULL, &brief), OK);
    assert_true(largest_difference(&seen.maps.albedo, &brief.maps.albedo) == 0);
    network_estimation_free(&brief);
    network_estimation_free(&seen);
    network_estimation_free(&made);
    img_free(&photo);
    img_free(&mask);
    network_close(n);
}

static int at_once(void)
{
    return 1;
}

static void normals_alone_are_those_of_all_maps(void **state)
{
    (void)state;
    network *n;
    img photo, mask, normal;
    network_estimation e;
    assert_int_equal(write_random_weights(scratch_path("w.safetensors")), OK);
    assert_int_equal(network_open(scratch_path("w.safetensors"), &n), OK);
    draw(&photo, &mask);
    for (int views = 1; views <= 3; views++) {
        assert_int_equal(network_estimate(n, &photo, &mask, NULL, views, NULL, &e), OK);
        assert_int_equal(network_normals(n, &photo, &mask, NULL, views, NULL, &normal), OK);
        assert_int_equal(normal.channels, 3);
        assert_memory_equal(normal.data, e.maps.normal.data, img_value_count(&normal) * sizeof(float));
        network_estimation_free(&e);
        img_free(&normal);
    }
    assert_int_equal(network_normals(n, &photo, &mask, NULL, 2, at_once, &normal), MERLIN_STOPPED);
    assert_null(normal.data);
    img_free(&photo);
    img_free(&mask);
    network_close(n);
}

static void a_wrong_number_of_views_is_refused(void **state)
{
    (void)state;
    network *n;
    img photo, mask, normal;
    network_estimation e;
    assert_int_equal(write_random_weights(scratch_path("w.safetensors")), OK);
    assert_int_equal(network_open(scratch_path("w.safetensors"), &n), OK);
    draw(&photo, &mask);
    assert_int_equal(network_estimate(n, &photo, &mask, NULL, 0, NULL, &e), MERLIN_WRONG_USE);
    assert_int_equal(network_estimate(n, &photo, &mask, NULL, 9, NULL, &e), MERLIN_WRONG_USE);
    assert_int_equal(network_normals(n, &photo, &mask, NULL, 0, NULL, &normal), MERLIN_WRONG_USE);
    network_features *features;
    assert_int_equal(network_features_new(n, &photo, &mask, NULL, 9, &features), MERLIN_WRONG_USE);
    assert_null(features);
    img_free(&photo);
    img_free(&mask);
    network_close(n);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(orientations_are_undone_by_their_inverse),
        in_scratch(the_mean_over_all_views_turns_with_the_photograph),
        in_scratch(the_light_that_is_found_turns_with_the_photograph),
        in_scratch(a_relit_picture_is_flipped_with_photograph_and_light),
        in_scratch(what_the_network_sees_becomes_the_estimate),
        in_scratch(normals_alone_are_those_of_all_maps),
        in_scratch(a_wrong_number_of_views_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
