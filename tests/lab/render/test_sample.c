/* SPDX-License-Identifier: MIT */
/* Samples on disk: what is written is read back, and files that are not samples are refused. */
#include "lab/render/sample.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "image/exr/exr.h"
#include "scratch.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { WIDTH = 20, HEIGHT = 20 };
static char path[64];

static void fill(img *image, int channels, float start)
{
    assert_int_equal(img_new(image, WIDTH, HEIGHT, channels), OK);
    /* multiples of 1/64 below 16 are exact in half float */
    for (int i = 0; i < WIDTH * HEIGHT * channels; i++)
        image->data[i] = start + (float)(i % 61) / 64;
}

static sample make_sample(void)
{
    sample s = {.light = {0, 0, 0},
                .light_power = 5.95f,
                .fov = 60,
                .seed = 0xfedcba9876543210u,
                .index = 1234567890123u,
                .generator_version = SAMPLE_GENERATOR_VERSION,
                .shape = "blend"};
    img *three[] = {&s.albedo, &s.normal, &s.direct, &s.indirect, &s.bounce2, &s.bounce3, &s.env};
    for (int i = 0; i < 7; i++)
        fill(three[i], 3, (float)i);
    fill(&s.roughness, 1, 7);
    fill(&s.depth, 1, 8);
    fill(&s.mask, 1, 9);
    s.target_count = 2;
    s.targets = calloc(2, sizeof *s.targets);
    for (int t = 0; t < 2; t++) {
        fill(&s.targets[t].direct, 3, 10 + (float)t);
        fill(&s.targets[t].indirect, 3, 12 + (float)t);
        s.targets[t].light = vec3_make(0.25f, (float)t, -1);
    }
    s.targets[1].axis = vec3_make(0, 0.6f, -0.8f);
    s.targets[1].lobe = 1.75f;
    s.lamp_count = 2;
    s.lamps = calloc(2, sizeof *s.lamps);
    for (int i = 0; i < 2; i++) {
        fill(&s.lamps[i].direct, 3, 14 + (float)i);
        fill(&s.lamps[i].indirect, 3, 15 - (float)i);
        fill(&s.lamps[i].visibility, 1, (float)i);
        s.lamps[i].at = vec3_make(-0.5f, (float)i, -2);
    }
    s.lamps[1].distant = true;
    s.lamps[1].radius = 0.125f;
    s.slant = (camera_slant){0.25f, -0.125f};
    for (int i = 0; i < 27; i++)
        s.sh[i / 3][i % 3] = (float)i / 7;
    return s;
}

static void assert_same_image(const img *a, const img *b)
{
    assert_int_equal(a->channels, b->channels);
    assert_memory_equal(a->data, b->data, (size_t)a->width * (size_t)a->height * (size_t)a->channels * sizeof(float));
}

static void sample_survives_writing_and_reading(void **state)
{
    (void)state;
    sample s = make_sample(), r;
    assert_int_equal(sample_write(path, &s), OK);
    assert_int_equal(sample_read(path, &r), OK);
    assert_same_image(&s.albedo, &r.albedo);
    assert_same_image(&s.normal, &r.normal);
    assert_same_image(&s.roughness, &r.roughness);
    assert_same_image(&s.depth, &r.depth);
    assert_same_image(&s.mask, &r.mask);
    assert_same_image(&s.direct, &r.direct);
    assert_same_image(&s.indirect, &r.indirect);
    assert_same_image(&s.bounce2, &r.bounce2);
    assert_same_image(&s.bounce3, &r.bounce3);
    assert_same_image(&s.env, &r.env);
    assert_int_equal(r.target_count, 2);
    assert_same_image(&s.targets[1].direct, &r.targets[1].direct);
    assert_same_image(&s.targets[0].indirect, &r.targets[0].indirect);
    assert_true(r.targets[1].axis.y == 0.6f && r.targets[1].axis.z == -0.8f && r.targets[1].lobe == 1.75f);
    assert_true(vec3_length(r.targets[0].axis) == 0 && r.targets[0].lobe == 0);
    assert_int_equal(r.lamp_count, 2);
    assert_same_image(&s.lamps[1].direct, &r.lamps[1].direct);
    assert_same_image(&s.lamps[0].indirect, &r.lamps[0].indirect);
    assert_same_image(&s.lamps[1].visibility, &r.lamps[1].visibility);
    assert_true(r.lamps[1].at.y == 1 && r.lamps[1].distant && r.lamps[1].radius == 0.125f && !r.lamps[0].distant);
    assert_true(r.slant.right == 0.25f && r.slant.up == -0.125f);
    assert_true(r.targets[1].light.y == 1 && r.light_power == 5.95f && r.fov == 60);
    assert_true(r.seed == s.seed && r.index == s.index && r.generator_version == SAMPLE_GENERATOR_VERSION);
    assert_string_equal(r.shape, "blend");
    assert_memory_equal(s.sh, r.sh, sizeof s.sh);
    sample_free(&s);
    sample_free(&r);
}

/* Files of point lights alone are what they were before there were LEDs. */
static void a_point_light_has_no_attributes_of_an_led(void **state)
{
    (void)state;
    sample s = make_sample();
    exr_file *f;
    assert_int_equal(sample_write(path, &s), OK);
    assert_int_equal(exr_open(path, &f), OK);
    assert_true(exr_has_attribute(f, "target00.light") && exr_has_attribute(f, "target01.light"));
    assert_true(exr_has_attribute(f, "target01.axis") && exr_has_attribute(f, "target01.lobe"));
    assert_false(exr_has_attribute(f, "target00.axis") || exr_has_attribute(f, "target00.lobe"));
    exr_close(f);
    sample_free(&s);
}

static void an_impossible_led_is_refused(void **state)
{
    (void)state;
    static const struct {
        vec3 axis;
        float lobe;
    } wrong[] = {{{0, 0, -1}, -1}, {{0, 0, 0}, 1}, {{0, 0, -2}, 1}, {{0, 0.5f, 0}, 0}};
    sample s = make_sample(), r;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        s.targets[1].axis = wrong[i].axis;
        s.targets[1].lobe = wrong[i].lobe;
        assert_int_equal(sample_write(path, &s), OK);
        assert_int_equal(sample_read(path, &r), MERLIN_BAD_INPUT);
        assert_non_null(strstr(status_message(), "impossible lobe"));
        assert_non_null(strstr(status_message(), "target01"));
    }
    sample_free(&s);
}

static void training_reads_no_more_than_it_needs(void **state)
{
    (void)state;
    sample s = make_sample(), r;
    assert_int_equal(sample_write(path, &s), OK);
    assert_int_equal(sample_read_training(path, &r), OK);
    assert_same_image(&s.indirect, &r.indirect);
    assert_null(r.env.data);
    assert_null(r.bounce2.data);
    assert_int_equal(r.target_count, 0);
    sample_free(&s);
    sample_free(&r);
}

static void training_reads_the_environment_where_it_is_asked_to(void **state)
{
    (void)state;
    sample s = make_sample(), r;
    float sh[9][3];
    assert_int_equal(sample_write(path, &s), OK);
    assert_int_equal(sample_read_training_environment(path, &r), OK);
    assert_same_image(&s.env, &r.env);
    assert_null(r.bounce2.data);
    assert_memory_equal(s.sh, r.sh, sizeof s.sh);
    assert_int_equal(sample_read_sh(path, sh), OK);
    assert_memory_equal(s.sh, sh, sizeof sh);
    sample_free(&r);
    img_free(&s.env);
    assert_int_equal(sample_write(path, &s), OK);
    assert_int_equal(sample_read_training_environment(path, &r), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "--no-env"));
    assert_int_equal(sample_read_sh(path, sh), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "--no-env"));
    sample_free(&s);
}

static void sample_without_a_layer_is_refused_by_name(void **state)
{
    (void)state;
    sample s = make_sample(), r;
    img_free(&s.roughness);
    assert_int_equal(sample_write(path, &s), OK);
    assert_int_equal(sample_read(path, &r), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "roughness.Y"));
    assert_int_equal(sample_read_training(path, &r), MERLIN_BAD_INPUT);
    sample_free(&s);
}

/* Infinity becomes half's largest number when it is written. */
static void sample_with_nan_is_refused(void **state)
{
    (void)state;
    sample s = make_sample(), r;
    s.depth.data[WIDTH * 3 + 5] = NAN;
    assert_int_equal(sample_write(path, &s), OK);
    assert_int_equal(sample_read(path, &r), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "depth.Z holds NaN or infinity at pixel 5,3"));
    s.depth.data[WIDTH * 3 + 5] = INFINITY;
    assert_int_equal(sample_write(path, &s), OK);
    assert_int_equal(sample_read(path, &r), OK);
    assert_true(r.depth.data[WIDTH * 3 + 5] == 65504);
    sample_free(&r);
    sample_free(&s);
}

static void sample_whose_light_or_environment_is_not_finite_is_refused(void **state)
{
    (void)state;
    sample s = make_sample(), r;
    float sh[9][3];
    s.sh[4][1] = NAN;
    assert_int_equal(sample_write(path, &s), OK);
    assert_int_equal(sample_read_training_environment(path, &r), MERLIN_BAD_INPUT);
    assert_int_equal(sample_read_sh(path, sh), MERLIN_BAD_INPUT);
    s.light.x = INFINITY;
    assert_int_equal(sample_write(path, &s), OK);
    assert_int_equal(sample_read_training(path, &r), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "light"));
    sample_free(&s);
}

static void image_that_is_no_sample_is_refused(void **state)
{
    (void)state;
    sample s = make_sample(), r;
    exr_channel red = {"R", s.albedo.data, 3, false};
    assert_int_equal(exr_write(path, WIDTH, HEIGHT, &red, 1, NULL, 0), OK);
    assert_int_equal(sample_read(path, &r), MERLIN_BAD_INPUT);
    assert_int_equal(file_write(path, "no EXR at all", 13), OK);
    assert_int_equal(sample_read(path, &r), MERLIN_BAD_INPUT);
    assert_null(r.albedo.data);
    sample_free(&s);
}

static int open_folder(void **state)
{
    scratch_open(state);
    snprintf(path, sizeof path, "%s/s.exr", scratch);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sample_survives_writing_and_reading),
        cmocka_unit_test(a_point_light_has_no_attributes_of_an_led),
        cmocka_unit_test(an_impossible_led_is_refused),
        cmocka_unit_test(training_reads_no_more_than_it_needs),
        cmocka_unit_test(training_reads_the_environment_where_it_is_asked_to),
        cmocka_unit_test(sample_without_a_layer_is_refused_by_name),
        cmocka_unit_test(sample_with_nan_is_refused),
        cmocka_unit_test(sample_whose_light_or_environment_is_not_finite_is_refused),
        cmocka_unit_test(image_that_is_no_sample_is_refused),
    };
    return cmocka_run_group_tests(tests, open_folder, scratch_close);
}
