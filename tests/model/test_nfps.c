/* SPDX-License-Identifier: MIT */
/* The network of near lights: its stages, its configuration. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/rng.h"
#include "compiled.h"
#include "model/model.h"
#include "model/nfps.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static void near(vec3 a, vec3 b, double tolerance)
{
    assert_true((double)vec3_length(vec3_sub(a, b)) <= tolerance);
}

static const model_config tiny = {.name = "tiny", .nfps_width = 8};

static nn_program *compile(model_part part, nn_purpose purpose, nn_params **params)
{
    nn_graph *g = NULL;
    nn_program *p = NULL;
    const nn_options options = {
        .batch = 6, .group = 3, .height = 16, .width = 16, .type = NN_FLOAT32, .purpose = purpose};
    status s = model_build(&tiny, part, &g);
    if (s == OK && !*params) s = nn_params_new(g, 7, params);
    if (s == OK) s = nn_compile(g, *params, &options, &p);
    nn_graph_free(g);
    if (s != OK) fail_msg("%s", status_message());
    return p;
}

static void fill(nn_program *p, const char *name, size_t count, float low)
{
    rng r = rng_at(5, count, 0);
    float *data = nn_input_data(p, name);
    for (size_t i = 0; data && i < count; i++)
        data[i] = rng_range(&r, low, 1);
}

static void fill_all(nn_program *p, const char *prefix, size_t pixels)
{
    static const struct {
        const char *name;
        size_t values;
        float low;
    } inputs[] = {{"picture", 6 * NFPS_PICTURE, 0},
                  {"light", 6 * NFPS_LIGHT, -1},
                  {"matte", 2 * NFPS_MATTE, -1},
                  {"mask", 2, 1},
                  {"normal", 2 * 3, -1},
                  {"normal_true", 2 * 3, -1},
                  {"loss_mask", 2, 1}};
    char name[32];
    for (size_t i = 0; i < sizeof inputs / sizeof *inputs; i++) {
        snprintf(name, sizeof name, "%s%s", prefix, inputs[i].name);
        fill(p, name, inputs[i].values * pixels, inputs[i].low);
    }
}

static void stages_learn_by_themselves(void **state)
{
    (void)state;
    nn_params *params = NULL;
    nn_program *p = compile(MODEL_TRAINING, NN_TRAIN, &params);
    fill_all(p, "", 256);
    fill_all(p, "first_", 64);
    static const char *const losses[] = {"first_normal", "normal"}, *const own[] = {"first.", "refine."};
    for (int i = 0; i < 2; i++) {
        nn_set_loss_weight(p, losses[i], 1);
        nn_set_loss_weight(p, losses[1 - i], 0);
        assert_int_equal(nn_forward(p), OK);
        assert_int_equal(nn_backward(p), OK);
        assert_true(isfinite(nn_total_loss(p)));
        assert_true(size_of_gradients(params, own[i]) > 0);
        assert_true(size_of_gradients(params, own[1 - i]) == 0);
    }
    nn_program_free(p);
    nn_params_free(params);
}

/* The stages alone, as they are used, are those of the whole network. */
static void stages_alone_give_the_wholes_normals(void **state)
{
    (void)state;
    nn_params *params = NULL;
    nn_program *whole = compile(MODEL_WHOLE, NN_INFER, &params), *alone = compile(MODEL_REFINE, NN_INFER, &params);
    fill_all(whole, "", 256);
    fill_all(whole, "first_", 64);
    fill_all(alone, "", 256);
    assert_int_equal(nn_forward(whole), OK);
    assert_int_equal(nn_forward(alone), OK);
    const float *a = nn_output_data(whole, "normal"), *b = nn_output_data(alone, "normal");
    assert_non_null(nn_output_data(whole, "first_normal"));
    for (int i = 0; i < 2 * 256; i++) {
        near(vec3_of(a + 3 * i), vec3_of(b + 3 * i), 1e-6);
        assert_true(fabsf(vec3_length(vec3_of(a + 3 * i)) - 1) < 1e-4f);
    }
    nn_program_free(alone);
    nn_program_free(whole);
    nn_params_free(params);
}

static void the_configuration_is_written_and_read(void **state)
{
    (void)state;
    model_config again;
    nn_graph *g = NULL;
    char *json = model_config_write(&tiny);
    assert_non_null(json);
    assert_int_equal(model_config_parse(json, strlen(json), "test", &again), OK);
    assert_memory_equal(&tiny, &again, sizeof tiny);
    free(json);
    static const char odd[] = "{\"name\": \"n\", \"nfps_width\": 12}";
    assert_int_equal(model_config_parse(odd, strlen(odd), "test", &again), MERLIN_BAD_INPUT);
    assert_int_equal(model_build(&tiny, MODEL_MAPS, &g), MERLIN_WRONG_USE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stages_learn_by_themselves),
        cmocka_unit_test(stages_alone_give_the_wholes_normals),
        cmocka_unit_test(the_configuration_is_written_and_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
