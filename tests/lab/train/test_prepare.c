/* SPDX-License-Identifier: MIT */
#include "prepare_fixture.h"

/* Flash and frame are the same in all eight orientations, so that the turned maps must render to the turned image. */
static void turned_maps_render_to_the_turned_image(void **state)
{
    fixture *f = *state;
    float *image = malloc(3 * PIXELS * sizeof(float));
    assert_non_null(image);
    for (int orientation = 0; orientation < ORIENTATIONS; orientation++) {
        assert_int_equal(train_dataset_get(f->data, 1, orientation, &f->view), OK);
        train_render(&f->view, vec3_make(0, 0, 0), image);
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
        assert_int_equal(train_dataset_get(f->data, 1, i, &f->view), OK);
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
    train_dataset *forgetful;
    assert_int_equal(train_dataset_open(f->folder, &(train_dataset_options){.size = SIZE}, &forgetful), OK);
    float *copy = malloc(FLOATS * sizeof(float));
    assert_non_null(copy);
    for (int pass = 0; pass < 2; pass++) {
        memset(f->memory, 0, FLOATS * sizeof(float));
        assert_int_equal(train_dataset_get(f->data, 2, 5, &f->view), OK);
        memcpy(copy, f->memory, FLOATS * sizeof(float));
        memset(f->memory, 0, FLOATS * sizeof(float));
        assert_int_equal(train_dataset_get(forgetful, 2, 5, &f->view), OK);
        assert_memory_equal(copy, f->memory, FLOATS * sizeof(float));
    }
    free(copy);
    train_dataset_close(forgetful);
}

static void sample_of_another_size_is_refused(void **state)
{
    fixture *f = *state;
    train_dataset *d;
    train_view v = f->view;
    v.size = 32;
    assert_int_equal(train_dataset_open(f->folder, &(train_dataset_options){.size = 32, .memory_gib = 1}, &d), OK);
    assert_int_equal(train_dataset_get(d, 0, 0, &v), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "64"));
    train_dataset_close(d);
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
        assert_int_equal(train_dataset_get(f->data, 0, 0, &f->view), MERLIN_BAD_INPUT);
        assert_non_null(strstr(status_message(), wrong[i].word));
    }
    rewrite(path, 60, LIGHT_POWER, vec3_make(0, 0, 0));
    assert_int_equal(train_dataset_get(f->data, 0, 0, &f->view), OK);
    free(path);
}

static void a_folder_is_of_its_first_samples_version(void **state)
{
    (void)state;
    char *folder = scratch_new();
    train_dataset *d;
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
    assert_int_equal(train_dataset_open(folder, &(train_dataset_options){.size = 32}, &d), OK);
    assert_int_equal(train_dataset_generator_version(d), 7);
    train_dataset_close(d);
    scratch_remove(folder);
}

static void empty_folder_is_refused(void **state)
{
    (void)state;
    char *folder = scratch_new();
    train_dataset *d;
    assert_int_equal(train_dataset_open(folder, &usual, &d), MERLIN_BAD_INPUT);
    scratch_remove(folder);
}

/* Opens the fixture's samples with their environments. */
static train_dataset *with_environments(fixture *f)
{
    train_dataset *d;
    train_dataset_options options = usual;
    options.environment = true;
    if (train_dataset_open(f->folder, &options, &d) != OK) fail_msg("%s", status_message());
    f->view.env = f->view.light + 3;
    f->view.sh = f->view.env + 3 * PIXELS;
    f->view.target_sh = f->view.sh + MODEL_SH;
    return d;
}

/* Without the flash, the maps under the turned coefficients give the turned image: diffuse and highlights. */
static void turned_maps_reflect_the_turned_environment(void **state)
{
    fixture *f = *state;
    train_dataset *d = with_environments(f);
    train_view *v = &f->view;
    for (int orientation = 0; orientation < ORIENTATIONS; orientation++) {
        assert_int_equal(train_dataset_get(d, 2, orientation, v), OK);
        float sh[9][3], alone[9][3];
        memcpy(sh, v->sh, sizeof sh);
        assert_int_equal(train_dataset_sh(d, 2, orientation, alone), OK);
        assert_memory_equal(sh, alone, sizeof sh);
        memset(v->relit, 0, 3 * PIXELS * sizeof(float));
        train_add_environment(v, (const float(*)[3])sh, v->relit);
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
    train_dataset_close(d);
}

static void photograph_is_lit_by_both_and_targets_add_up(void **state)
{
    fixture *f = *state;
    train_dataset *d = with_environments(f);
    train_view *v = &f->view;
    float *raw = malloc(FLOATS * sizeof(float));
    assert_non_null(raw);
    assert_int_equal(train_dataset_get(d, 0, 0, v), OK);
    memcpy(raw, f->memory, FLOATS * sizeof(float));
    const float *direct = raw + (v->direct - f->memory), *indirect = raw + (v->indirect - f->memory);
    const float *env = raw + (v->env - f->memory), *sh = raw + (v->sh - f->memory);
    train_camera lens = train_camera_perfect();
    lens.white = 4;
    train_lighting lighting = {.target = {0.5f, 0, -0.5f}, .strength = 0.5f};
    sphere_sky(1, lighting.target_sh);
    rng r = rng_at(1, 2, 3);
    train_prepare(v, true, &lens, &lighting, &r);
    for (int i = 0; i < 3 * PIXELS; i++) {
        if (v->mask[i / 3] == 0) continue;
        assert_float_equal(v->image[i] * v->image[i], direct[i] + indirect[i] + 0.5f * env[i], 1e-4);
        assert_float_equal(v->reconstruction[i], v->direct[i] + v->indirect[i], 1e-6);
        /* these environments are exactly their coefficients: only bounces are left, within half floats' 4e-3 */
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
    train_dataset_close(d);
}

static void target_is_lit_by_its_own_environment(void **state)
{
    fixture *f = *state;
    train_dataset *d = with_environments(f);
    float *dark = malloc(3 * PIXELS * sizeof(float));
    assert_non_null(dark);
    train_camera lens = train_camera_perfect();
    train_lighting lighting = {.target = {0.8f, 0, -1}, .strength = 1};
    int brighter = 0;
    for (int pass = 0; pass < 2; pass++) {
        rng r = rng_at(1, 2, 3);
        if (pass) sphere_sky(2, lighting.target_sh);
        assert_int_equal(train_dataset_get(d, 0, 0, &f->view), OK);
        train_prepare(&f->view, true, &lens, &lighting, &r);
        if (pass == 0) memcpy(dark, f->view.relit, 3 * PIXELS * sizeof(float));
    }
    for (int i = 0; i < 3 * PIXELS; i++)
        brighter += f->view.relit[i] > dark[i] + 0.05f;
    assert_true(brighter > PIXELS / 10);
    free(dark);
    train_dataset_close(d);
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
        cmocka_unit_test_setup_teardown(turned_maps_reflect_the_turned_environment, set_up, tear_down),
        cmocka_unit_test_setup_teardown(photograph_is_lit_by_both_and_targets_add_up, set_up, tear_down),
        cmocka_unit_test_setup_teardown(target_is_lit_by_its_own_environment, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
