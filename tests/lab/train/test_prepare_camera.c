/* SPDX-License-Identifier: MIT */
/* The camera's effects on the photograph of a sample. */
#include "prepare_fixture.h"

static const train_lighting at_the_camera = {.target = {0, 0, 0}};

static void perfect_camera_shows_direct_plus_indirect(void **state)
{
    fixture *f = *state;
    for (int global = 0; global < 2; global++) {
        rng r = rng_at(1, 2, 3);
        assert_int_equal(train_dataset_get(f->data, 0, 0, &f->view), OK);
        train_camera lens = train_camera_perfect();
        train_prepare(&f->view, global, &lens, &(train_lighting){.target = {0.5f, 0, -0.5f}}, &r);
        const train_view *v = &f->view;
        for (int i = 0; i < 3 * PIXELS; i++) {
            float linear = v->image[i] * v->image[i];
            if (v->reconstruction[i] < 1 && v->direct[i] < 1) /* where nothing was clipped */
                assert_float_equal(linear, global ? v->reconstruction[i] : v->direct[i], 1e-5);
            assert_true(v->mask[i / 3] == 1 || v->image[i] == 0);
            assert_true(v->mask[i / 3] == 0 || v->mask[i / 3] == 1);
        }
    }
}

static void sensor_saturates_at_its_white(void **state)
{
    fixture *f = *state;
    rng r = rng_at(1, 2, 3);
    assert_int_equal(train_dataset_get(f->data, 0, 0, &f->view), OK);
    float *radiance = malloc(3 * PIXELS * sizeof(float));
    assert_non_null(radiance);
    for (int i = 0; i < 3 * PIXELS; i++)
        radiance[i] = f->view.direct[i] *= 4; /* bright enough for both kinds of pixel */
    train_camera lens = train_camera_perfect();
    lens.white = 2;
    train_prepare(&f->view, false, &lens, &at_the_camera, &r);
    int saturated = 0, below = 0;
    for (int i = 0; i < 3 * PIXELS; i++) {
        if (f->view.mask[i / 3] == 0) continue;
        float expected = radiance[i] < 2 ? radiance[i] : 2;
        assert_float_equal(f->view.image[i] * f->view.image[i], expected, 1e-5); /* float rounding of the root */
        saturated += radiance[i] >= 2;
        below += radiance[i] > 1 && radiance[i] < 2;
    }
    assert_true(saturated > 0 && below > 0);
    free(radiance);
}

static void camera_spoils_the_input_and_not_the_targets(void **state)
{
    fixture *f = *state;
    train_config c = {.exposure_jitter = 0.3, .colour_jitter = 0.1};
    float *clean = malloc(FLOATS * sizeof(float));
    assert_non_null(clean);
    train_camera perfect = train_camera_perfect();
    rng r = rng_at(1, 2, 3);
    assert_int_equal(train_dataset_get(f->data, 0, 0, &f->view), OK);
    train_prepare(&f->view, true, &perfect, &at_the_camera, &r);
    memcpy(clean, f->memory, FLOATS * sizeof(float));
    const float *image = clean + (f->view.image - f->memory);
    for (uint64_t i = 0; i < 20; i++) {
        r = rng_at(1, i, 3);
        train_camera lens = train_camera_draw(&c, &r);
        for (int k = 0; k < 3; k++)
            assert_true(fabsf(logf(lens.gain[k])) <= 0.4f + 1e-5f);
        assert_int_equal(train_dataset_get(f->data, 0, 0, &f->view), OK);
        train_prepare(&f->view, true, &lens, &at_the_camera, &r);
        assert_memory_not_equal(f->view.image, image, 3 * PIXELS * sizeof(float));
        memcpy(f->view.image, image, 3 * PIXELS * sizeof(float));
        assert_memory_equal(f->memory, clean, FLOATS * sizeof(float));
    }
    free(clean);
}

/* Photographs sample 0 without noise with these faults. */
static void photograph(fixture *f, const train_camera *lens)
{
    rng r = rng_at(1, 2, 3);
    assert_int_equal(train_dataset_get(f->data, 0, 0, &f->view), OK);
    for (int x = 0; x < SIZE; x++) /* a row of the frame where the object covers three quarters of each pixel */
        if (f->view.mask[32 * SIZE + x] > 0) f->view.mask[32 * SIZE + x] = 0.75f;
    assert_int_equal(train_prepare(&f->view, true, lens, &at_the_camera, &r), OK);
}

static void background_shows_where_the_object_does_not_cover_the_pixel(void **state)
{
    fixture *f = *state;
    float clean[3 * PIXELS];
    train_camera lens = train_camera_perfect();
    photograph(f, &lens);
    memcpy(clean, f->view.image, sizeof clean);
    lens.background = true;
    for (int c = 0; c < 3; c++)
        lens.behind[0][c] = lens.behind[1][c] = 0.2f;
    photograph(f, &lens);
    int leaks = 0;
    for (int i = 0; i < 3 * PIXELS; i++) {
        if (i / 3 / SIZE != 32 || f->view.mask[i / 3] == 0) {
            assert_true(f->view.image[i] == clean[i]);
            continue;
        }
        /* the input is the square root of the radiance */
        float brighter = f->view.image[i] * f->view.image[i] - clean[i] * clean[i];
        if (clean[i] < 0.9f) assert_true(fabsf(brighter - 0.25f * 0.2f) < 1e-4f);
        leaks++;
    }
    assert_true(leaks > 30);
}

static int count_ones(const float *mask)
{
    int ones = 0;
    for (int i = 0; i < PIXELS; i++)
        ones += mask[i] == 1;
    return ones;
}

/* Pixels that the outline's error removed must not count in the losses. */
static void outline_errors_are_one_pixel_wide(void **state)
{
    fixture *f = *state;
    train_camera lens = train_camera_perfect();
    float exact[PIXELS], loss[PIXELS];
    photograph(f, &lens);
    memcpy(exact, f->view.mask, sizeof exact);
    memcpy(loss, f->view.loss_mask, sizeof loss);
    for (lens.outline = -1; lens.outline <= 1; lens.outline += 2) {
        photograph(f, &lens);
        int changed = abs(count_ones(f->view.mask) - count_ones(exact));
        /* a disc's outline of 4-neighbours has 4√2 r pixels; its radius is (area/π)^½ */
        float outline = 5.657f * sqrtf((float)count_ones(exact) / 3.1416f);
        assert_true(fabsf((float)changed - outline) < 0.15f * outline);
        for (int i = 0; i < PIXELS; i++) {
            assert_true(lens.outline > 0 ? f->view.mask[i] >= exact[i] : f->view.mask[i] <= exact[i]);
            assert_true(f->view.loss_mask[i] == fminf(loss[i], f->view.mask[i]));
            if (f->view.mask[i] == 0) assert_true(f->view.image[3 * i] == 0);
        }
    }
}

/* A dilated mask adds a pixel beside row 32, of which the object covers a quarter; it must be as dark as that. */
static void a_mask_too_large_shows_what_the_object_covers_in_part(void **state)
{
    fixture *f = *state;
    train_view *v = &f->view;
    train_camera lens = train_camera_perfect();
    rng r = rng_at(1, 2, 3);
    lens.outline = 1;
    assert_int_equal(train_dataset_get(f->data, 0, 0, v), OK);
    size_t edge = (size_t)32 * SIZE;
    while (v->mask[edge] == 0)
        edge++;
    v->mask[edge] = 0.25f;
    for (size_t c = 0; c < 3; c++) {
        v->direct[3 * edge + c] = 0.2f;
        v->indirect[3 * edge + c] = 0;
    }
    assert_int_equal(train_prepare(v, true, &lens, &at_the_camera, &r), OK);
    assert_true(v->mask[edge] == 1 && v->loss_mask[edge] == 0);
    /* the input is the square root of the radiance */
    for (size_t c = 0; c < 3; c++)
        assert_float_equal(v->image[3 * edge + c] * v->image[3 * edge + c], 0.2f, 1e-6);
}

static void jpeg_spoils_the_input_and_not_the_targets(void **state)
{
    fixture *f = *state;
    float clean[FLOATS], error[2] = {0, 0};
    train_camera lens = train_camera_perfect();
    photograph(f, &lens);
    memcpy(clean, f->memory, sizeof clean);
    const float *image = clean + (f->view.image - f->memory);
    lens.jpeg = true;
    for (int k = 0; k < 2; k++) {
        lens.jpeg_settings = (img_jpeg){.quality = k ? 95 : 50, .halved = !k};
        photograph(f, &lens);
        for (int i = 0; i < 3 * PIXELS; i++)
            error[k] += fabsf(f->view.image[i] - image[i]) / (3 * PIXELS);
        memcpy(f->view.image, image, 3 * PIXELS * sizeof(float));
        assert_memory_equal(f->memory, clean, 28 * PIXELS * sizeof(float));
    }
    /* quality 95 quantizes by a step or two of 255, quality 50 by ten and more, and mixes the stripes' colours */
    assert_true(error[1] > 0 && error[1] < 0.01f && error[0] > 2 * error[1] && error[0] < 0.1f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(perfect_camera_shows_direct_plus_indirect, set_up, tear_down),
        cmocka_unit_test_setup_teardown(sensor_saturates_at_its_white, set_up, tear_down),
        cmocka_unit_test_setup_teardown(camera_spoils_the_input_and_not_the_targets, set_up, tear_down),
        cmocka_unit_test_setup_teardown(background_shows_where_the_object_does_not_cover_the_pixel, set_up, tear_down),
        cmocka_unit_test_setup_teardown(outline_errors_are_one_pixel_wide, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_mask_too_large_shows_what_the_object_covers_in_part, set_up, tear_down),
        cmocka_unit_test_setup_teardown(jpeg_spoils_the_input_and_not_the_targets, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
