/* SPDX-License-Identifier: MIT */
/* The choice of a model for the light of a photograph: by its photographer's word, its camera's, or what the first
 * sees. */
#include <limits.h>
#include <math.h>
#include <unistd.h>

#include "base/api_needs.h"
#include "estimate/light/found_light.h"
#include "merlin/merlin.h"
#include "scratch.h"
#include "weights.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { SIDE = 96 };

typedef struct fixture {
    char *folder, any[160], flash[160];
    merlin_image photo, mask;
} fixture;

static int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    *state = f;
    f->folder = scratch_new();
    snprintf(f->any, sizeof f->any, "%s/any.safetensors", f->folder);
    snprintf(f->flash, sizeof f->flash, "%s/flash.safetensors", f->folder);
    f->photo = (merlin_image){SIDE, SIDE, 3, calloc(3 * SIDE * SIDE, sizeof(float))};
    f->mask = (merlin_image){SIDE, SIDE, 1, calloc(SIDE * SIDE, sizeof(float))};
    for (int i = 0; i < SIDE * SIDE; i++) {
        float x = ((float)(i % SIDE) - 48) / 40, y = ((float)(i / SIDE) - 48) / 40, d = x * x + y * y;
        f->mask.data[i] = d < 1;
        for (int c = 0; c < 3; c++)
            f->photo.data[3 * i + c] = d < 1 ? 0.1f + 0.6f * sqrtf(1 - d) : 0;
    }
    return write_random_weights(f->flash) == OK ? 0 : -1;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    merlin_image_free(&f->photo);
    merlin_image_free(&f->mask);
    scratch_remove(f->folder);
    free(f);
    return 0;
}

/* Makes the model of any light see this one in every photograph. */
static void see(const fixture *f, const float code[MODEL_LIGHTS])
{
    model_config config;
    nn_params *params = NULL;
    assert_int_equal(write_random_weights_of("merlin-any", f->any), OK);
    assert_int_equal(model_load(f->any, &config, &params), OK);
    nn_param *weight = nn_params_find(params, "lights.fc2.weight"), *bias = nn_params_find(params, "lights.fc2.bias");
    assert_non_null(weight);
    assert_non_null(bias);
    memset(weight->value, 0, weight->count * sizeof(float));
    for (int i = 0; i < MODEL_LIGHTS; i++)
        bias->value[i] = 10 * code[i]; /* the network says a tenth of what its last layer does */
    char *json = model_config_write(&config);
    assert_int_equal(write_params(f->any, params, json), OK);
    free(json);
    nn_params_free(params);
}

/* Returns the name of the model whose maps are given out. */
static const char *made_by(const fixture *f, const merlin_params *asked, char name[64])
{
    merlin_params p = *asked;
    merlin_model *model = NULL;
    merlin_maps maps;
    p.size = 64;
    p.views = 1;
    assert_int_equal(merlin_model_open(f->any, &model), MERLIN_OK);
    assert_int_equal(merlin_model_add_flash(model, f->flash), MERLIN_OK);
    assert_int_equal(merlin_estimate(model, &f->photo, &f->mask, &p, &maps), MERLIN_OK);
    snprintf(name, 64, "%s", maps.model);
    assert_int_equal(maps.light.known, strcmp(name, "merlin-any") == 0);
    /* and what bounces in new light is of that model */
    merlin_image relit;
    assert_int_equal(merlin_relight(model, &maps, (const float[]){0.5f, 0.5f, 0}, MERLIN_BY_BRDF, &relit), MERLIN_OK);
    merlin_image_free(&relit);
    merlin_maps_free(&maps);
    merlin_model_close(model);
    return name;
}

static void flash_code(float strength, float other, float code[MODEL_LIGHTS])
{
    memset(code, 0, MODEL_LIGHTS * sizeof *code);
    code[MODEL_LIGHTS_FLASH] = model_encode_strength(strength);
    code[MODEL_LIGHTS_LAMP] = other > 0 ? 0.9f : 0;
    for (int c = 0; c < 3; c++)
        code[MODEL_LIGHTS_STRENGTH + c] = model_encode_strength(other);
}

static void what_is_seen_decides(void **state)
{
    const fixture *f = *state;
    const merlin_params p = merlin_params_default();
    float code[MODEL_LIGHTS];
    char name[64];
    flash_code(1, 0, code);
    see(f, code);
    assert_string_equal(made_by(f, &p, name), "merlin-point");
    flash_code(1, 1, code);
    see(f, code);
    assert_string_equal(made_by(f, &p, name), "merlin-any");
}

static void the_camera_and_the_photographer_know_better(void **state)
{
    const fixture *f = *state;
    merlin_params p = merlin_params_default();
    float code[MODEL_LIGHTS];
    char name[64];
    flash_code(1, 0, code);
    see(f, code);
    p.shot.flash = MERLIN_FLASH_NONE;
    assert_string_equal(made_by(f, &p, name), "merlin-any");
    flash_code(0, 1, code);
    see(f, code);
    p.flash = 1;
    assert_string_equal(made_by(f, &p, name), "merlin-point");
}

static void a_model_of_one_light_takes_no_other_beside_it(void **state)
{
    const fixture *f = *state;
    float code[MODEL_LIGHTS] = {0};
    merlin_model *model = NULL;
    see(f, code);
    assert_int_equal(merlin_model_open(f->flash, &model), MERLIN_OK);
    assert_int_equal(merlin_model_add_flash(model, f->any), MERLIN_WRONG_USE);
    assert_non_null(strstr(merlin_error(), "merlin-point tells no flash"));
    merlin_model_close(model);
    assert_int_equal(merlin_model_open(f->any, &model), MERLIN_OK);
    assert_int_equal(merlin_model_add_flash(model, "none.safetensors"), MERLIN_BAD_INPUT);
    assert_int_equal(merlin_model_add_flash(model, f->flash), MERLIN_OK);
    assert_int_equal(merlin_model_add_flash(model, f->flash), MERLIN_WRONG_USE);
    assert_int_equal(merlin_model_add_flash(NULL, f->flash), MERLIN_WRONG_USE);
    merlin_model_close(model);
}

static void lights_are_told_by_a_model_that_compares(void **state)
{
    const fixture *f = *state;
    float code[MODEL_LIGHTS] = {0};
    merlin_model *model = NULL;
    see(f, code);
    char lights[160];
    snprintf(lights, sizeof lights, "%s/lights.safetensors", f->folder);
    assert_int_equal(write_random_weights_of("merlin-lights", lights), OK);
    assert_int_equal(merlin_model_open(lights, &model), MERLIN_BAD_INPUT);
    assert_int_equal(merlin_model_open(f->flash, &model), MERLIN_OK);
    assert_int_equal(merlin_model_add_several(model, lights), MERLIN_WRONG_USE);
    merlin_model_close(model);
    assert_int_equal(merlin_model_open(f->any, &model), MERLIN_OK);
    assert_int_equal(merlin_model_add_several(model, "none.safetensors"), MERLIN_BAD_INPUT);
    assert_int_equal(merlin_model_add_several(model, f->any), MERLIN_WRONG_USE);
    assert_int_equal(merlin_model_add_several(model, lights), MERLIN_OK);
    assert_int_equal(merlin_model_add_several(model, lights), MERLIN_WRONG_USE);
    assert_int_equal(merlin_model_add_several(NULL, lights), MERLIN_WRONG_USE);
    merlin_model_close(model);
}

static void weights_for_flashes_are_read_when_one_is_seen(void **state)
{
    const fixture *f = *state;
    merlin_params p = merlin_params_default();
    float code[MODEL_LIGHTS];
    merlin_model *model = NULL;
    merlin_maps maps;
    p.size = 64;
    p.views = 1;
    flash_code(0, 1, code);
    see(f, code);
    assert_int_equal(merlin_model_open(f->any, &model), MERLIN_OK);
    assert_int_equal(merlin_model_add_flash(model, f->flash), MERLIN_OK);
    assert_int_equal(write_random_weights_of("merlin-env-deep", f->flash), OK);
    assert_int_equal(merlin_estimate(model, &f->photo, &f->mask, &p, &maps), MERLIN_OK);
    merlin_maps_free(&maps);
    p.flash = 1;
    assert_int_equal(merlin_estimate(model, &f->photo, &f->mask, &p, &maps), MERLIN_BAD_INPUT);
    assert_non_null(strstr(merlin_error(), "was replaced by other weights"));
    assert_int_equal(truncate(f->flash, 1000), 0);
    assert_int_equal(merlin_estimate(model, &f->photo, &f->mask, &p, &maps), MERLIN_BAD_INPUT);
    merlin_model_close(model);
    assert_int_equal(write_random_weights(f->flash), OK);
}

static merlin_maps maps_of(const fixture *f, merlin_model **model)
{
    merlin_params p = merlin_params_default();
    merlin_maps maps;
    p.size = 64;
    p.views = 1;
    assert_int_equal(merlin_model_open(f->any, model), MERLIN_OK);
    assert_int_equal(merlin_estimate(*model, &f->photo, &f->mask, &p, &maps), MERLIN_OK);
    return maps;
}

static merlin_image relit(merlin_model *model, const merlin_maps *maps, const float light[3])
{
    merlin_image out;
    assert_int_equal(merlin_relight(model, maps, light, MERLIN_BY_BRDF, &out), MERLIN_OK);
    return out;
}

static void found_light_is_the_sum_of_its_lamps(void **state)
{
    const fixture *f = *state;
    const float flash = 0.05f, strength = 0.1f, far = 0.8f, at[3] = {0.48f, 0, -1 + 0.64f};
    float code[MODEL_LIGHTS];
    merlin_model *model;
    merlin_image found;
    flash_code(flash, strength, code);
    code[MODEL_LIGHTS_LAMP] = 0.6f;
    code[MODEL_LIGHTS_LAMP + 2] = 0.8f;
    code[MODEL_LIGHTS_DISTANCE] = 1 / far;
    see(f, code);
    merlin_maps maps = maps_of(f, &model);
    found_light_take(code, &maps.light); /* as told, not as fitted to the photograph */
    merlin_image a = relit(model, &maps, (const float[]){0, 0, 0}), b = relit(model, &maps, at);
    assert_int_equal(merlin_relight_found(model, &maps, 0, MERLIN_BY_BRDF, &found), MERLIN_OK);
    /* random weights bounce light that may be below zero, and each picture ends there */
    int compared = 0;
    for (int i = 0; i < 3 * SIDE * SIDE; i++) {
        if (!(a.data[i] > 0 && a.data[i] < 1 && b.data[i] > 0 && b.data[i] < 1)) continue;
        assert_float_equal(found.data[i], flash * a.data[i] + strength * far * far * b.data[i], 1e-3);
        compared++;
    }
    assert_true(compared > 1000);
    merlin_image_free(&a);
    merlin_image_free(&b);
    merlin_image_free(&found);
    merlin_maps_free(&maps);
    merlin_model_close(model);
}

static double apart(const merlin_image *a, const merlin_image *b)
{
    double sum = 0;
    for (int i = 0; i < 3 * SIDE * SIDE; i++)
        sum += fabs((double)(a->data[i] - b->data[i]));
    return sum / (3 * SIDE * SIDE);
}

static void found_light_is_kept_and_turns(void **state)
{
    const fixture *f = *state;
    float code[MODEL_LIGHTS], sh[9][3] = {{1, 0.8f, 0.6f}, {0.2f}, {0}, {0.5f, 0.5f, 0.5f}};
    char folder[300];
    merlin_model *model;
    merlin_maps kept;
    merlin_image before, after, turned;
    flash_code(0.3f, 0.4f, code);
    model_encode_sh((const float(*)[3])sh, code + MODEL_LIGHTS_REST);
    see(f, code);
    merlin_maps maps = maps_of(f, &model);
    snprintf(folder, sizeof folder, "%s/maps", f->folder);
    assert_int_equal(merlin_maps_write(model, &maps, NULL, folder), MERLIN_OK);
    assert_int_equal(merlin_maps_read(folder, &kept), MERLIN_OK);
    assert_memory_equal(&kept.light, &maps.light, sizeof kept.light);
    assert_int_equal(merlin_relight_found(model, &maps, 0, MERLIN_BY_BRDF, &before), MERLIN_OK);
    assert_int_equal(merlin_relight_found(model, &kept, 360, MERLIN_BY_BRDF, &after), MERLIN_OK);
    assert_int_equal(merlin_relight_found(model, &kept, 180, MERLIN_BY_BRDF, &turned), MERLIN_OK);
    assert_true(apart(&before, &after) < 2e-3); /* maps.exr is of half floats */
    assert_true(apart(&before, &turned) > 1e-2);
    merlin_image_free(&before);
    merlin_image_free(&after);
    merlin_image_free(&turned);
    kept.light.known = 0;
    assert_int_equal(merlin_relight_found(model, &kept, 0, MERLIN_BY_BRDF, &after), MERLIN_BAD_INPUT);
    kept.light = (merlin_found_light){.known = 1};
    assert_int_equal(merlin_relight_found(model, &kept, 0, MERLIN_BY_BRDF, &after), MERLIN_BAD_INPUT);
    assert_int_equal(merlin_relight_found(model, &maps, 0, MERLIN_BY_NETWORK, &after), MERLIN_WRONG_USE);
    assert_int_equal(merlin_relight_found(model, &maps, NAN, MERLIN_BY_BRDF, &after), MERLIN_WRONG_USE);
    merlin_maps_free(&kept);
    merlin_maps_free(&maps);
    merlin_model_close(model);
}

static void share_of_the_flash(void **state)
{
    (void)state;
    float code[MODEL_LIGHTS], sh[9][3] = {{0}};
    merlin_found_light light;
    flash_code(1, 0, code);
    found_light_take(code, &light);
    assert_float_equal(found_light_share(&light).flash, 1, 1e-6);
    flash_code(1, 3, code);
    found_light_take(code, &light);
    assert_float_equal(found_light_share(&light).flash, 0.25f, 1e-4);
    /* surroundings of radiance 1 send pi to whatever faces them */
    flash_code(1, 0, code);
    for (int c = 0; c < 3; c++)
        sh[0][c] = 2 * sqrtf((float)PI);
    model_encode_sh((const float(*)[3])sh, code + MODEL_LIGHTS_REST);
    found_light_take(code, &light);
    assert_float_equal(found_light_share(&light).flash, 5.95f / (5.95f + (float)PI), 1e-3);
    assert_float_equal(found_light_share(&(merlin_found_light){0}).flash, 0, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_seen_decides),
        cmocka_unit_test(the_camera_and_the_photographer_know_better),
        cmocka_unit_test(a_model_of_one_light_takes_no_other_beside_it),
        cmocka_unit_test(lights_are_told_by_a_model_that_compares),
        cmocka_unit_test(weights_for_flashes_are_read_when_one_is_seen),
        cmocka_unit_test(found_light_is_the_sum_of_its_lamps),
        cmocka_unit_test(found_light_is_kept_and_turns),
        cmocka_unit_test(share_of_the_flash),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
