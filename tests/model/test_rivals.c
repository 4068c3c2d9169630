/* SPDX-License-Identifier: MIT */
/* The paper's rivals: their size as published, their outputs as PyTorch has them (tests/reference/make_rivals.py), and
 * that a stage does not change the one before. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compiled.h"
#include "model/model.h"
#include "reference.h"

enum { SIZE = 64, STRIDE = 8 };

static model_config rival(model_rival which, int cascades)
{
    char json[128];
    model_config c;
    snprintf(json, sizeof json, "{\"name\": \"r\", \"rival\": \"%s\", \"cascades\": %d}",
             which == MODEL_LI ? "li" : "sang", cascades);
    if (model_config_parse(json, strlen(json), "test", &c) != OK) fail_msg("%s", status_message());
    return c;
}

static nn_program *compile(const model_config *c, model_part part, nn_purpose purpose, nn_params **params)
{
    nn_program *p = compiled(c, part, purpose, 1, SIZE, params);
    if (!p) fail_msg("%s: %s", c->name, status_message());
    return p;
}

/* Asserts parameters in millions and multiply-adds in billions at 256×256, each to 2 %. */
static void check_cost(model_rival which, int cascades, double millions, double billions)
{
    const model_config c = rival(which, cascades);
    nn_params *params = NULL;
    nn_program *p = compile(&c, MODEL_WHOLE, NN_INFER, &params);
    const nn_cost cost = nn_program_cost(p);
    const double own = (double)cost.parameter_count / 1e6, work = cost.forward_flops * 16 / 2e9;
    print_message("%s, %d cascades: %.2f M parameters, %.2f GMAC at 256x256\n", which == MODEL_LI ? "Li" : "Sang",
                  cascades, own, work);
    assert_true(fabs(own - millions) <= 0.02 * millions);
    assert_true(fabs(work - billions) <= 0.02 * billions);
    nn_program_free(p);
    nn_params_free(params);
}

/* Li's first stage is counted with the two networks of bounces, 4.9 million and 4.0 billion each. */
static void their_cost_is_as_published(void **state)
{
    (void)state;
    check_cost(MODEL_SANG, 0, 17.7, 26.6);
    check_cost(MODEL_SANG, 2, 25.6, 71);
    check_cost(MODEL_LI, 0, 26.4 + 9.8, 10 + 8);
    check_cost(MODEL_LI, 2, 48, 82);
}

static void fill_inputs(nn_program *p)
{
    float *mask = nn_input_data(p, "mask"), *image = nn_input_data(p, "image"), *light = nn_input_data(p, "light");
    reference_fill_disc(mask, 1, SIZE, 26);
    reference_fill(image, "image", SIZE * SIZE * 3, 0.5, 0.5);
    for (int i = 0; i < SIZE * SIZE * 3; i++)
        image[i] *= mask[i / 3];
    if (light) reference_fill(light, "light", 3, 1, 0);
    reference_fill(nn_input_data(p, "light_position"), "light_position", 3, 0.5, 0);
}

static void check_outputs(model_rival which, const char *kind)
{
    static const char *const names[] = {"albedo", "normal",   "roughness",    "depth",
                                        "direct", "indirect", "relit_direct", "relit_brdf"};
    const model_config c = rival(which, 1);
    nn_params *params = NULL;
    safetensors_file *f;
    nn_program *p = compile(&c, MODEL_WHOLE, NN_INFER, &params);
    if (safetensors_open(MERLIN_SOURCE_DIR "/tests/reference/rivals.safetensors", &f) != OK)
        fail_msg("%s", status_message());
    reference_fill_params(params);
    fill_inputs(p);
    assert_int_equal(nn_forward(p), OK);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        reference_compare_output(f, kind, names[i], nn_output_data(p, names[i]), SIZE, STRIDE,
                                 1e-4); /* test_reference.c */
    safetensors_close(f);
    nn_program_free(p);
    nn_params_free(params);
}

static void their_outputs_are_pytorchs(void **state)
{
    (void)state;
    check_outputs(MODEL_SANG, "sang");
    check_outputs(MODEL_LI, "li");
}

static void set_weights(nn_program *p, const char *prefix, float weight)
{
    static const char *const names[] = {"albedo", "normal", "depth", "roughness", "relight"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char name[64];
        snprintf(name, sizeof name, "%s%s", prefix, names[i]);
        nn_set_loss_weight(p, name, weight);
    }
}

static void check_stages(model_rival which)
{
    const model_config c = rival(which, 1);
    nn_params *params = NULL;
    nn_program *p = compile(&c, MODEL_TRAINING, NN_TRAIN, &params);
    fill_inputs(p);
    memcpy(nn_input_data(p, "loss_mask"), nn_input_data(p, "mask"), SIZE * SIZE * sizeof(float));
    set_weights(p, "stage0.", 0); /* the first stage's own losses */
    assert_int_equal(nn_forward(p), OK);
    assert_int_equal(nn_backward(p), OK);
    assert_true(isfinite(nn_total_loss(p)));
    assert_true(size_of_gradients(params, "encoder.") == 0);
    assert_true(size_of_gradients(params, "material") == 0);
    assert_true(size_of_gradients(params, "cascade1.") > 0);
    set_weights(p, "stage0.", 1);
    assert_int_equal(nn_forward(p), OK);
    assert_int_equal(nn_backward(p), OK);
    assert_true(size_of_gradients(params, "encoder.") > 0);
    nn_program_free(p);
    nn_params_free(params);
}

static void a_stage_learns_without_changing_the_one_before(void **state)
{
    (void)state;
    check_stages(MODEL_SANG);
    check_stages(MODEL_LI);
}

static void their_configuration_is_written_and_read(void **state)
{
    (void)state;
    const model_config c = rival(MODEL_SANG, 2);
    model_config again;
    char *json = model_config_write(&c);
    assert_non_null(json);
    assert_int_equal(model_config_parse(json, strlen(json), "test", &again), OK);
    assert_memory_equal(&c, &again, sizeof c);
    free(json);
    const char *unknown = "{\"name\": \"r\", \"rival\": \"sang\", \"cascades\": 2, \"widths\": [8, 8, 8, 8, 8]}";
    assert_int_equal(model_config_parse(unknown, strlen(unknown), "test", &again), MERLIN_BAD_INPUT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(their_cost_is_as_published),
        cmocka_unit_test(their_outputs_are_pytorchs),
        cmocka_unit_test(a_stage_learns_without_changing_the_one_before),
        cmocka_unit_test(their_configuration_is_written_and_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
