/* SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "lab/eval/metrics/metrics.h"
#include "lab/eval/samples/trivial.h"
#include "scratch.h"
#include "sphere.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

static const sphere ball = {{0.1f, -0.05f, -1.2f}, 0.35f, {0.6f, 0.4f, 0.2f}, 0.7f, 96};

static void write_sphere(const char *folder, const sphere *of, uint64_t index)
{
    sample s;
    assert_int_equal(sphere_sample(of, 0, &s), OK);
    s.index = index;
    char *path = sample_path(folder, index);
    assert_non_null(path);
    assert_int_equal(sample_write(path, &s), OK);
    free(path);
    sample_free(&s);
}

static void an_inflated_sphere_comes_close_to_the_sphere(void **state)
{
    (void)state;
    sample s;
    surface guess;
    eval_photo photo;
    eval_means means = {.roughness = 0.7f, .depth = 0.95f};
    assert_int_equal(sphere_sample(&ball, 0, &s), OK);
    assert_int_equal(eval_photo_take(&s, &s.direct, &s.mask, 8, &photo), OK); /* nothing saturates */
    assert_int_equal(eval_inflate(&photo, &s.mask, &means, &guess), OK);
    /* perspective turns a sphere's outline by up to asin(0.35/1.2) = 17° against the parallel view of the inflation */
    assert_true(eval_angle(&guess.normal, &s.normal, &s.mask) < 12);
    assert_true(eval_mse(&guess.roughness, &s.roughness, &s.mask) < 1e-12);
    double sum = 0, count = 0;
    for (int i = 0; i < 96 * 96; i++) {
        if (s.mask.data[i] <= 0) continue;
        sum += guess.depth.data[i];
        count++;
    }
    assert_true(fabs(sum / count - 0.95) < 1e-4);
    /* where the surface faces the flash the albedo is right, but for the depth and the highlight taken for paint */
    camera view = {.width = 96, .height = 96, .fov = 60};
    float x, y;
    camera_project(&view, ball.centre, &x, &y);
    float green = img_at(&guess.albedo, (int)x, (int)y)[1];
    assert_true(green > 0.4f && green < 0.75f);
    surface_free(&guess);
    eval_photo_free(&photo);
    sample_free(&s);
}

static void means_of_one_sample_are_the_sample(void **state)
{
    (void)state;
    char *folder = scratch_new();
    write_sphere(folder, &ball, 0);
    write_sphere(folder, &ball, 1);
    sample s;
    eval_means means;
    assert_int_equal(sphere_sample(&ball, 0, &s), OK);
    assert_int_equal(eval_means_of_folder(folder, 0, true, NULL, &means), OK);
    assert_int_equal(means.samples, 2);
    /* half floats keep 11 bits */
    assert_true(eval_mse(&means.maps.albedo, &s.albedo, &s.mask) < 1e-6);
    assert_true(eval_mse(&means.maps.normal, &s.normal, &s.mask) < 1e-6);
    assert_true(eval_mse(&means.maps.depth, &s.depth, &s.mask) < 1e-6);
    assert_true(fabsf(means.roughness - 0.7f) < 2e-3f);
    /* outside every mask stands the mean over all */
    assert_true(fabsf(means.maps.albedo.data[0] - 0.6f) < 2e-3f);
    eval_means_free(&means);
    sample_free(&s);
    scratch_remove(folder);
}

static void means_survive_their_file_and_another_size(void **state)
{
    (void)state;
    char *folder = scratch_new();
    write_sphere(folder, &ball, 0);
    eval_means means, back;
    char *path = file_join(folder, "means.exr");
    assert_int_equal(eval_means_of_folder(folder, 0, true, NULL, &means), OK);
    assert_int_equal(eval_means_write(&means, path), OK);
    assert_int_equal(eval_means_read(path, 96, 96, &back), OK);
    for (int i = 0; i < 96 * 96; i++) {
        assert_true(fabsf(back.maps.depth.data[i] - means.maps.depth.data[i]) < 1e-3f);
        assert_true(fabsf(back.maps.roughness.data[i] - means.maps.roughness.data[i]) < 2e-3f);
    }
    assert_true(fabsf(back.depth - means.depth) < 1e-6f && back.samples == 1);
    eval_means_free(&back);
    assert_int_equal(eval_means_read(path, 128, 64, &back), OK);
    assert_int_equal(back.maps.normal.width, 128);
    assert_int_equal(back.maps.normal.height, 64);
    for (int i = 0; i < 128 * 64; i++) {
        const float *n = back.maps.normal.data + 3 * i;
        assert_true(fabsf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1) < 1e-5f);
    }
    eval_means_free(&back);
    eval_means_free(&means);
    free(path);
    scratch_remove(folder);
}

static void samples_of_two_sizes_have_no_mean(void **state)
{
    (void)state;
    char *folder = scratch_new();
    sphere small = ball;
    small.size = 64;
    write_sphere(folder, &ball, 0);
    write_sphere(folder, &small, 1);
    eval_means means;
    assert_int_equal(eval_means_of_folder(folder, 0, true, NULL, &means), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "000001.exr"));
    scratch_remove(folder);
}

static int polled;
static int stop_at_the_second(void)
{
    return ++polled == 2;
}

static void means_can_be_stopped(void **state)
{
    (void)state;
    char *folder = scratch_new();
    write_sphere(folder, &ball, 0);
    write_sphere(folder, &ball, 1);
    eval_means means;
    polled = 0;
    assert_int_equal(eval_means_of_folder(folder, 0, true, stop_at_the_second, &means), MERLIN_STOPPED);
    assert_non_null(strstr(status_message(), "1 of 2 samples"));
    assert_null(means.maps.albedo.data);
    scratch_remove(folder);
}

static void a_sample_is_no_file_of_means(void **state)
{
    (void)state;
    char *folder = scratch_new();
    write_sphere(folder, &ball, 0);
    char *path = sample_path(folder, 0);
    eval_means means;
    assert_int_equal(eval_means_read(path, 96, 96, &means), MERLIN_BAD_INPUT);
    free(path);
    scratch_remove(folder);
}

static void means_without_samples_or_depth_are_refused(void **state)
{
    (void)state;
    char *folder = scratch_new();
    write_sphere(folder, &ball, 0);
    char *path = file_join(folder, "means.exr");
    eval_means means, back;
    assert_int_equal(eval_means_of_folder(folder, 0, true, NULL, &means), OK);
    for (int i = 0; i < 2; i++) {
        eval_means wrong = means;
        if (i == 0) wrong.samples = 0;
        if (i == 1) wrong.depth = -1;
        assert_int_equal(eval_means_write(&wrong, path), OK);
        assert_int_equal(eval_means_read(path, 96, 96, &back), MERLIN_BAD_INPUT);
    }
    eval_means_free(&means);
    free(path);
    scratch_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_inflated_sphere_comes_close_to_the_sphere),
        cmocka_unit_test(means_of_one_sample_are_the_sample),
        cmocka_unit_test(means_survive_their_file_and_another_size),
        cmocka_unit_test(samples_of_two_sizes_have_no_mean),
        cmocka_unit_test(means_can_be_stopped),
        cmocka_unit_test(a_sample_is_no_file_of_means),
        cmocka_unit_test(means_without_samples_or_depth_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
