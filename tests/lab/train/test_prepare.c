/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "lab/train/dataset.h"
#include "lab/train/prepare.h"
#include "optics/orientation.h"

/* cmocka names a macro fail, so that it comes behind base/status.h */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "prepared.h"

static const trn_lighting at_the_camera = {.target = {0, 0, 0}};

/* The flash and the frame look the same in all eight orientations, so the turned maps must render to the turned image.
 */
static void turned_maps_render_to_the_turned_image(void **state)
{
    fixture *f = *state;
    float *image = malloc(3 * PIXELS * sizeof(float));
    assert_non_null(image);
    for (int orientation = 0; orientation < ORIENTATIONS; orientation++) {
        assert_int_equal(trn_dataset_get(f->data, 1, orientation, &f->view), OK);
        trn_render(&f->view, vec3_make(0, 0, 0), image);
        int inside = 0;
        for (int i = 0; i < 3 * PIXELS; i++) {
            /* normals in half floats are off by 5e-4, radiance in half by another 5e-4 of up to 1 */
            assert_float_equal(image[i], fminf(f->view.direct[i], 1), 4e-3);
            inside += image[i] > 0.05f;
        }
        assert_true(inside > PIXELS / 10);
    }
    free(image);
}

static void the_eight_orientations_differ(void **state)
{
    fixture *f = *state;
    float *all = malloc(ORIENTATIONS * 3 * PIXELS * sizeof(float));
    assert_non_null(all);
    for (int i = 0; i < ORIENTATIONS; i++) {
        assert_int_equal(trn_dataset_get(f->data, 1, i, &f->view), OK);
        memcpy(all + (size_t)i * 3 * PIXELS, f->view.direct, 3 * PIXELS * sizeof(float));
        for (int k = 0; k < i; k++)
            assert_memory_not_equal(all + (size_t)i * 3 * PIXELS, all + (size_t)k * 3 * PIXELS,
                                    3 * PIXELS * sizeof(float));
    }
    free(all);
}

static void sample_from_memory_equals_sample_from_disk(void **state)
{
    fixture *f = *state;
    trn_dataset *forgetful;
    assert_int_equal(trn_dataset_open(f->folder, &(trn_dataset_options){.size = SIZE}, &forgetful), OK);
    float *copy = malloc(FLOATS * sizeof(float));
    assert_non_null(copy);
    for (int pass = 0; pass < 2; pass++) {
        memset(f->memory, 0, FLOATS * sizeof(float));
        assert_int_equal(trn_dataset_get(f->data, 2, 5, &f->view), OK);
        memcpy(copy, f->memory, FLOATS * sizeof(float));
        memset(f->memory, 0, FLOATS * sizeof(float));
        assert_int_equal(trn_dataset_get(forgetful, 2, 5, &f->view), OK);
        assert_memory_equal(copy, f->memory, FLOATS * sizeof(float));
    }
    free(copy);
    trn_dataset_close(forgetful);
}

static void sample_of_another_size_is_refused(void **state)
{
    fixture *f = *state;
    trn_dataset *d;
    trn_view v = f->view;
    v.size = 32;
    assert_int_equal(trn_dataset_open(f->folder, &(trn_dataset_options){.size = 32, .memory_gib = 1}, &d), OK);
    assert_int_equal(trn_dataset_get(d, 0, 0, &v), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "64"));
    trn_dataset_close(d);
}

static void rewrite(const char *path, float fov, float power, vec3 light)
{
    sample s;
    assert_int_equal(sample_read(path, &s), OK);
    s.fov = fov, s.light_power = power, s.light = light;
    assert_int_equal(sample_write(path, &s), OK);
    sample_free(&s);
}

static void sample_of_another_camera_or_flash_is_refused(void **state)
{
    fixture *f = *state;
    static const struct {
        float fov, power;
        vec3 light;
        const char *word;
    } wrong[] = {{40, LIGHT_POWER, {0, 0, 0}, "field of view of 40"},
                 {60, 1, {0, 0, 0}, "power 1"},
                 {60, LIGHT_POWER, {0.5f, 0, 0}, "at the camera"}};
    char *path = sample_path(f->folder, 0);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        rewrite(path, wrong[i].fov, wrong[i].power, wrong[i].light);
        assert_int_equal(trn_dataset_get(f->data, 0, 0, &f->view), MERLIN_BAD_INPUT);
        assert_non_null(strstr(status_message(), wrong[i].word));
    }
    rewrite(path, 60, LIGHT_POWER, vec3_make(0, 0, 0));
    assert_int_equal(trn_dataset_get(f->data, 0, 0, &f->view), OK);
    free(path);
}

static void a_folder_is_of_its_first_samples_version(void **state)
{
    (void)state;
    char *folder = scratch_new();
    trn_dataset *d;
    for (int i = 0; i < 2; i++) {
        sphere_write(folder, 32, i);
        char *path = sample_path(folder, (uint64_t)i);
        sample s;
        assert_int_equal(sample_read(path, &s), OK);
        s.generator_version = 7 + i;
        assert_int_equal(sample_write(path, &s), OK);
        sample_free(&s);
        free(path);
    }
    assert_int_equal(trn_dataset_open(folder, &(trn_dataset_options){.size = 32}, &d), OK);
    assert_int_equal(trn_dataset_generator_version(d), 7);
    trn_dataset_close(d);
    scratch_remove(folder);
}

static void empty_folder_is_refused(void **state)
{
    (void)state;
    char *folder = scratch_new();
    trn_dataset *d;
    assert_int_equal(trn_dataset_open(folder, &usual, &d), MERLIN_BAD_INPUT);
    scratch_remove(folder);
}

static void perfect_camera_shows_direct_plus_indirect(void **state)
{
    fixture *f = *state;
    for (int global = 0; global < 2; global++) {
        rng r = rng_at(1, 2, 3);
        assert_int_equal(trn_dataset_get(f->data, 0, 0, &f->view), OK);
        trn_camera lens = trn_camera_perfect();
        trn_prepare(&f->view, global, &lens, &(trn_lighting){.target = {0.5f, 0, -0.5f}}, &r);
        const trn_view *v = &f->view;
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
    assert_int_equal(trn_dataset_get(f->data, 0, 0, &f->view), OK);
    float *radiance = malloc(3 * PIXELS * sizeof(float));
    assert_non_null(radiance);
    for (int i = 0; i < 3 * PIXELS; i++)
        radiance[i] = f->view.direct[i] *= 4; /* bright enough for both kinds of pixel */
    trn_camera lens = trn_camera_perfect();
    lens.white = 2;
    trn_prepare(&f->view, false, &lens, &at_the_camera, &r);
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
    trn_camera perfect = trn_camera_perfect();
    rng r = rng_at(1, 2, 3);
    assert_int_equal(trn_dataset_get(f->data, 0, 0, &f->view), OK);
    trn_prepare(&f->view, true, &perfect, &at_the_camera, &r);
    memcpy(clean, f->memory, FLOATS * sizeof(float));
    const float *image = clean + (f->view.image - f->memory);
    for (uint64_t i = 0; i < 20; i++) {
        r = rng_at(1, i, 3);
        trn_camera lens = trn_camera_draw(&c, &r);
        for (int k = 0; k < 3; k++)
            assert_true(fabsf(logf(lens.gain[k])) <= 0.4f + 1e-5f);
        assert_int_equal(trn_dataset_get(f->data, 0, 0, &f->view), OK);
        trn_prepare(&f->view, true, &lens, &at_the_camera, &r);
        assert_memory_not_equal(f->view.image, image, 3 * PIXELS * sizeof(float));
        memcpy(f->view.image, image, 3 * PIXELS * sizeof(float));
        assert_memory_equal(f->memory, clean, FLOATS * sizeof(float));
    }
    free(clean);
}

/* Sample 0 photographed without noise under these faults. */
static void photograph(fixture *f, const trn_camera *lens)
{
    rng r = rng_at(1, 2, 3);
    assert_int_equal(trn_dataset_get(f->data, 0, 0, &f->view), OK);
    for (int x = 0; x < SIZE; x++) /* a row of the frame where the object covers three quarters of each pixel */
        if (f->view.mask[32 * SIZE + x] > 0) f->view.mask[32 * SIZE + x] = 0.75f;
    assert_int_equal(trn_prepare(&f->view, true, lens, &at_the_camera, &r), OK);
}

static void background_shows_where_the_object_does_not_cover_the_pixel(void **state)
{
    fixture *f = *state;
    float clean[3 * PIXELS];
    trn_camera lens = trn_camera_perfect();
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

/* Nothing is asked of the network where the outline took the object from it. */
static void outline_errors_are_one_pixel_wide(void **state)
{
    fixture *f = *state;
    trn_camera lens = trn_camera_perfect();
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

/* The pixel that a mask too large adds beside row 32, of which the object covers a quarter, is as dark as that. */
static void a_mask_too_large_shows_what_the_object_covers_in_part(void **state)
{
    fixture *f = *state;
    trn_view *v = &f->view;
    trn_camera lens = trn_camera_perfect();
    rng r = rng_at(1, 2, 3);
    lens.outline = 1;
    assert_int_equal(trn_dataset_get(f->data, 0, 0, v), OK);
    size_t edge = (size_t)32 * SIZE;
    while (v->mask[edge] == 0)
        edge++;
    v->mask[edge] = 0.25f;
    for (size_t c = 0; c < 3; c++) {
        v->direct[3 * edge + c] = 0.2f;
        v->indirect[3 * edge + c] = 0;
    }
    assert_int_equal(trn_prepare(v, true, &lens, &at_the_camera, &r), OK);
    assert_true(v->mask[edge] == 1 && v->loss_mask[edge] == 0);
    /* the input is the square root of the radiance */
    for (size_t c = 0; c < 3; c++)
        assert_float_equal(v->image[3 * edge + c] * v->image[3 * edge + c], 0.2f, 1e-6);
}

static void jpeg_spoils_the_input_and_not_the_targets(void **state)
{
    fixture *f = *state;
    float clean[FLOATS], error[2] = {0, 0};
    trn_camera lens = trn_camera_perfect();
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

/* What earlier runs were trained with does not change. */
static void photographs_have_no_faults_unless_asked_for(void **unused)
{
    (void)unused;
    train_config none = {0}, all = {.background_leak = 1, .outline_error = 1, .jpeg = 1};
    for (uint64_t i = 0; i < 100; i++) {
        trn_camera lens = trn_camera_perfect();
        rng r = rng_at(1, i, 3);
        trn_camera_spoil(&none, &r, &lens);
        assert_false(lens.background || lens.outline || lens.jpeg);
        trn_camera_spoil(&all, &r, &lens);
        assert_true(lens.background && abs(lens.outline) == 1 && lens.jpeg);
    }
}

/* Those of them that are to be as in the paper lose the draw of exposure, noise and white, too. */
static void perfect_cameras_are_as_many_as_asked_for(void **unused)
{
    (void)unused;
    enum { DRAWS = 2000 };
    train_config half = {.exposure_jitter = 0.3, .colour_jitter = 0.1, .background_leak = 1, .perfect_camera = 0.5};
    trn_camera perfect = trn_camera_perfect();
    int count = 0;
    for (uint64_t i = 0; i < DRAWS; i++) {
        rng r = rng_at(1, i, 3);
        trn_camera lens = trn_camera_draw(&half, &r);
        trn_camera_spoil(&half, &r, &lens);
        bool is_perfect = memcmp(lens.gain, perfect.gain, sizeof lens.gain) == 0 && lens.white == perfect.white;
        assert_true(is_perfect != lens.background);
        count += is_perfect;
    }
    /* five standard deviations of a binomial count */
    assert_in_range(count, DRAWS / 2 - 112, DRAWS / 2 + 112);
}

static void target_lights_lie_on_the_frontal_hemisphere(void **unused)
{
    (void)unused;
    rng r = rng_at(5, 6, 7);
    for (int i = 0; i < 1000; i++) {
        vec3 light = trn_draw_light(&r);
        assert_float_equal(vec3_length(vec3_sub(light, vec3_make(0, 0, -1))), 1, 1e-5);
        assert_true(light.z >= -1);
    }
}

/* ---- both lights ---- */

/* The fixture's samples with their environments. */
static trn_dataset *with_environments(fixture *f)
{
    trn_dataset *d;
    trn_dataset_options options = usual;
    options.environment = true;
    if (trn_dataset_open(f->folder, &options, &d) != OK) fail_msg("%s", status_message());
    f->view.env = f->view.light + 3;
    f->view.sh = f->view.env + 3 * PIXELS;
    f->view.target_sh = f->view.sh + MODEL_SH;
    return d;
}

static vec3 random_direction(rng *r)
{
    float z = rng_range(r, -1, 1), phi = rng_range(r, 0, 6.2831853f), s = sqrtf(1 - z * z);
    return vec3_make(s * cosf(phi), s * sinf(phi), z);
}

/* As trn_dataset_get turns normals; rows run downwards, y upwards. */
static vec3 turned(int orientation, vec3 d)
{
    if (orientation & ORIENTATION_FLIP_X) d.x = -d.x;
    if (orientation & ORIENTATION_FLIP_Y) d.y = -d.y;
    return orientation & ORIENTATION_TRANSPOSE ? vec3_make(-d.y, -d.x, d.z) : d;
}

static void turned_sky_in_a_turned_direction_is_the_sky(void **unused)
{
    (void)unused;
    rng r = rng_at(3, 1, 4);
    for (int orientation = 0; orientation < ORIENTATIONS; orientation++) {
        float before[9][3], after[9][3];
        sphere_sky(1, before);
        sphere_sky(1, after);
        orientation_turn_sh(orientation, after);
        for (int i = 0; i < 50; i++) {
            vec3 d = random_direction(&r);
            vec3 a = sh_irradiance((const float(*)[3])before, d);
            vec3 b = sh_irradiance((const float(*)[3])after, turned(orientation, d));
            assert_float_equal(a.x, b.x, 1e-5); /* nine float terms of size 1 in another order */
            assert_float_equal(a.z, b.z, 1e-5);
        }
    }
}

/* Without the flash, the maps under the turned coefficients are the turned image: diffuse and highlights. */
static void turned_maps_reflect_the_turned_environment(void **state)
{
    fixture *f = *state;
    trn_dataset *d = with_environments(f);
    trn_view *v = &f->view;
    for (int orientation = 0; orientation < ORIENTATIONS; orientation++) {
        assert_int_equal(trn_dataset_get(d, 2, orientation, v), OK);
        float sh[9][3], alone[9][3];
        memcpy(sh, v->sh, sizeof sh);
        assert_int_equal(trn_dataset_sh(d, 2, orientation, alone), OK);
        assert_memory_equal(sh, alone, sizeof sh);
        memset(v->relit, 0, 3 * PIXELS * sizeof(float));
        trn_add_environment(v, (const float(*)[3])sh, v->relit);
        camera c = {.width = SIZE, .height = SIZE, .fov = 60};
        int inside = 0;
        for (int i = 0; i < PIXELS; i++) {
            if (v->mask[i] == 0) continue;
            vec3 view = vec3_scale(camera_ray(&c, (float)(i % SIZE) + 0.5f, (float)(i / SIZE) + 0.5f), -1);
            vec3 n = vec3_make(v->normal[3 * i], v->normal[3 * i + 1], v->normal[3 * i + 2]);
            float expected = v->relit[3 * i] + ambient_specular((const float(*)[3])sh, 0.5f, n, view).x;
            assert_float_equal(v->env[3 * i], expected, 4e-3); /* normals and image are half floats */
            inside++;
        }
        assert_true(inside > PIXELS / 10);
    }
    trn_dataset_close(d);
}

static void photograph_is_lit_by_both_and_targets_add_up(void **state)
{
    fixture *f = *state;
    trn_dataset *d = with_environments(f);
    trn_view *v = &f->view;
    float *raw = malloc(FLOATS * sizeof(float));
    assert_non_null(raw);
    assert_int_equal(trn_dataset_get(d, 0, 0, v), OK);
    memcpy(raw, f->memory, FLOATS * sizeof(float));
    const float *direct = raw + (v->direct - f->memory), *indirect = raw + (v->indirect - f->memory);
    const float *env = raw + (v->env - f->memory), *sh = raw + (v->sh - f->memory);
    trn_camera lens = trn_camera_perfect();
    lens.white = 4;
    trn_lighting lighting = {.target = {0.5f, 0, -0.5f}, .strength = 0.5f};
    sphere_sky(1, lighting.target_sh);
    rng r = rng_at(1, 2, 3);
    trn_prepare(v, true, &lens, &lighting, &r);
    for (int i = 0; i < 3 * PIXELS; i++) {
        if (v->mask[i / 3] == 0) continue;
        assert_float_equal(v->image[i] * v->image[i], direct[i] + indirect[i] + 0.5f * env[i], 1e-4);
        assert_float_equal(v->reconstruction[i], v->direct[i] + v->indirect[i], 1e-6);
        /* these surroundings are what their coefficients say: only bounces are left, within half floats' 4e-3 */
        assert_float_equal(v->indirect[i], indirect[i], 4e-3);
        assert_true(v->direct[i] > fminf(direct[i], 1) + 0.02f);
        assert_true(v->relit[i] >= 0 && v->relit[i] <= 1);
    }
    float code[MODEL_SH], scaled[9][3];
    for (int i = 0; i < MODEL_SH; i++)
        scaled[i / 3][i % 3] = 0.5f * sh[i];
    model_encode_sh((const float(*)[3])scaled, code);
    assert_memory_equal(code, v->sh, sizeof code);
    free(raw);
    trn_dataset_close(d);
}

static void target_is_lit_by_its_own_environment(void **state)
{
    fixture *f = *state;
    trn_dataset *d = with_environments(f);
    float *dark = malloc(3 * PIXELS * sizeof(float));
    assert_non_null(dark);
    trn_camera lens = trn_camera_perfect();
    trn_lighting lighting = {.target = {0.8f, 0, -1}, .strength = 1};
    int brighter = 0;
    for (int pass = 0; pass < 2; pass++) {
        rng r = rng_at(1, 2, 3);
        if (pass) sphere_sky(2, lighting.target_sh);
        assert_int_equal(trn_dataset_get(d, 0, 0, &f->view), OK);
        trn_prepare(&f->view, true, &lens, &lighting, &r);
        if (pass == 0) memcpy(dark, f->view.relit, 3 * PIXELS * sizeof(float));
    }
    for (int i = 0; i < 3 * PIXELS; i++)
        brighter += f->view.relit[i] > dark[i] + 0.05f;
    assert_true(brighter > PIXELS / 10);
    free(dark);
    trn_dataset_close(d);
}

static void strengths_span_a_decade(void **unused)
{
    (void)unused;
    rng r = rng_at(5, 6, 7);
    int weak = 0;
    for (int i = 0; i < 1000; i++) {
        float s = trn_draw_strength(&r);
        assert_true(s >= 0.099f && s <= 1.001f);
        weak += s < 0.316f;
    }
    assert_in_range(weak, 400, 600); /* half of them, standard deviation 16 */
}

static void a_share_of_targets_is_dark(void **unused)
{
    (void)unused;
    rng r = rng_at(5, 6, 7);
    int dark = 0;
    for (int i = 0; i < 1000; i++) {
        float s = trn_draw_target_strength(0.25f, &r);
        assert_true(s == 0 || (s >= 0.099f && s <= 1.001f));
        dark += s == 0;
        assert_true(trn_draw_target_strength(0, &r) > 0);
    }
    assert_in_range(dark, 200, 300); /* standard deviation 14 */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(turned_maps_render_to_the_turned_image, set_up, tear_down),
        cmocka_unit_test_setup_teardown(the_eight_orientations_differ, set_up, tear_down),
        cmocka_unit_test_setup_teardown(sample_from_memory_equals_sample_from_disk, set_up, tear_down),
        cmocka_unit_test_setup_teardown(sample_of_another_size_is_refused, set_up, tear_down),
        cmocka_unit_test_setup_teardown(sample_of_another_camera_or_flash_is_refused, set_up, tear_down),
        cmocka_unit_test(a_folder_is_of_its_first_samples_version),
        cmocka_unit_test(empty_folder_is_refused),
        cmocka_unit_test_setup_teardown(perfect_camera_shows_direct_plus_indirect, set_up, tear_down),
        cmocka_unit_test_setup_teardown(sensor_saturates_at_its_white, set_up, tear_down),
        cmocka_unit_test_setup_teardown(camera_spoils_the_input_and_not_the_targets, set_up, tear_down),
        cmocka_unit_test(turned_sky_in_a_turned_direction_is_the_sky),
        cmocka_unit_test_setup_teardown(turned_maps_reflect_the_turned_environment, set_up, tear_down),
        cmocka_unit_test_setup_teardown(photograph_is_lit_by_both_and_targets_add_up, set_up, tear_down),
        cmocka_unit_test_setup_teardown(target_is_lit_by_its_own_environment, set_up, tear_down),
        cmocka_unit_test(strengths_span_a_decade),
        cmocka_unit_test(a_share_of_targets_is_dark),
        cmocka_unit_test(target_lights_lie_on_the_frontal_hemisphere),
        cmocka_unit_test_setup_teardown(background_shows_where_the_object_does_not_cover_the_pixel, set_up, tear_down),
        cmocka_unit_test_setup_teardown(outline_errors_are_one_pixel_wide, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_mask_too_large_shows_what_the_object_covers_in_part, set_up, tear_down),
        cmocka_unit_test_setup_teardown(jpeg_spoils_the_input_and_not_the_targets, set_up, tear_down),
        cmocka_unit_test(photographs_have_no_faults_unless_asked_for),
        cmocka_unit_test(perfect_cameras_are_as_many_as_asked_for),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
