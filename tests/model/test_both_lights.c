/* SPDX-License-Identifier: MIT */
/* Setting B: a flash and an environment in one photograph. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/rng.h"
#include "compiled.h"
#include "model/model.h"
#include "optics/sh.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { SIZE = 32, PIXELS = SIZE * SIZE, BATCH = 4 };

static const model_config both = {.name = "both",
                                  .input_global = true,
                                  .material_decoders = 1,
                                  .feature_sharing = true,
                                  .gated_attention = true,
                                  .relight = MODEL_RELIGHT_NETWORK,
                                  .global_illumination = true,
                                  .lighting = MODEL_LIGHT_BOTH,
                                  .widths = {16, 16, 16, 16, 16},
                                  .gi_widths = {8, 8, 8, 8, 8}};

static nn_program *compile(const model_config *c, model_part part, nn_purpose purpose, nn_params **params)
{
    nn_program *p = compiled(c, part, purpose, BATCH, SIZE, params);
    if (!p) fail_msg("%s: %s", c->name, status_message());
    return p;
}

static void fill(nn_program *p, const char *name, size_t count, float low, float high)
{
    float *x = nn_input_data(p, name);
    assert_non_null(x);
    rng r = rng_at(11, strlen(name), (uint64_t)name[0]);
    for (size_t i = 0; i < BATCH * count; i++)
        x[i] = rng_range(&r, low, high);
}

static void set(nn_program *p, const char *name, size_t count, float value)
{
    float *x = nn_input_data(p, name);
    assert_non_null(x);
    for (size_t i = 0; i < BATCH * count; i++)
        x[i] = value;
}

static void fill_inputs(nn_program *p)
{
    fill(p, "image", 3 * PIXELS, 0, 1);
    set(p, "mask", PIXELS, 1);
    fill(p, "light", 3 + MODEL_SH, -0.5f, 0.5f);
    fill(p, "light_position", 3, -0.5f, 0.5f);
}

static void fill_targets(nn_program *p)
{
    static const char *const three[] = {"albedo_true",   "normal_true",         "direct_true",
                                        "indirect_true", "reconstruction_true", "relit_true"};
    set(p, "loss_mask", PIXELS, 1);
    for (int i = 0; i < 6; i++)
        fill(p, three[i], 3 * PIXELS, 0, 0.8f);
    fill(p, "roughness_true", PIXELS, -1, 1);
    fill(p, "depth_true", PIXELS, 0.8f, 1.2f);
    fill(p, "environment_true", MODEL_SH, -0.5f, 0.5f);
}

static void model_of_both_lights_has_its_names(void **unused)
{
    (void)unused;
    nn_params *params = NULL;
    nn_program *p = compile(&both, MODEL_WHOLE, NN_INFER, &params);
    static const char *const outputs[] = {"direct",     "environment", "environment_code", "indirect", "relit_direct",
                                          "relit_brdf", "albedo"};
    fill_inputs(p);
    assert_int_equal(nn_forward(p), OK);
    for (int i = 0; i < 7; i++)
        assert_non_null(nn_output_data(p, outputs[i]));
    assert_non_null(nn_params_find(params, "environment.fc1.weight"));
    nn_program_free(p);
    nn_params_free(params);

    model_config point = both;
    point.lighting = MODEL_LIGHT_POINT;
    params = NULL;
    p = compile(&point, MODEL_WHOLE, NN_INFER, &params);
    assert_null(nn_output_data(p, "environment"));
    assert_null(nn_params_find(params, "environment.fc1.weight"));
    nn_program_free(p);
    nn_params_free(params);
}

/* The albedo is white; the direct light is that of the code's definition and of src/optics. */
static void environment_is_that_of_its_code(void **unused)
{
    (void)unused;
    nn_params *params = NULL;
    nn_program *p = compile(&both, MODEL_WHOLE, NN_INFER, &params);
    fill_inputs(p);
    assert_int_equal(nn_forward(p), OK);
    const float *code = nn_output_data(p, "environment_code") + (BATCH - 1) * MODEL_SH;
    const float *albedo = nn_output_data(p, "albedo"), *normal = nn_output_data(p, "normal");
    const float *shown = nn_output_data(p, "environment");
    float sh[9][3], largest = 0;
    model_decode_sh(code, sh);
    for (size_t i = (BATCH - 1) * PIXELS; i < BATCH * PIXELS; i++) {
        const float *n = normal + 3 * i;
        vec3 e = sh_irradiance((const float(*)[3])sh, vec3_make(n[0], n[1], n[2]));
        float expected = (0.5f + 0.5f * albedo[3 * i]) * e.x / 3.14159265f;
        assert_float_equal(shown[3 * i], expected, 1e-4); /* nine float terms of size 1 */
        largest = fmaxf(largest, fabsf(expected));
    }
    assert_true(largest > 1e-3f);
    nn_program_free(p);
    nn_params_free(params);
}

static void code_is_decoded_to_what_was_encoded(void **unused)
{
    (void)unused;
    float sh[9][3], code[MODEL_SH], again[9][3];
    for (int i = 0; i < MODEL_SH; i++)
        sh[i / 3][i % 3] = sinf((float)i);
    model_encode_sh((const float(*)[3])sh, code);
    model_decode_sh(code, again);
    for (int i = 0; i < MODEL_SH; i++)
        assert_float_equal(again[i / 3][i % 3], sh[i / 3][i % 3], 1e-6);
}

/* Parseval's theorem, as stated in the header. */
static void squared_code_is_the_mean_square_of_white_surfaces(void **unused)
{
    (void)unused;
    float sh[9][3], code[MODEL_SH];
    for (int i = 0; i < MODEL_SH; i++)
        sh[i / 3][i % 3] = sinf(1 + 2.0f * (float)i);
    model_encode_sh((const float(*)[3])sh, code);
    double by_code = 0, by_surfaces = 0;
    for (int i = 0; i < 9; i++)
        by_code += (double)(code[3 * i] * code[3 * i]);
    enum { STEPS = 60 };
    for (int i = 0; i < STEPS * STEPS; i++) {
        float z = 1 - 2 * ((float)(i / STEPS) + 0.5f) / STEPS, phi = 6.2831853f * ((float)(i % STEPS) + 0.5f) / STEPS;
        float s = sqrtf(1 - z * z);
        double e = (double)sh_irradiance((const float(*)[3])sh, vec3_make(s * cosf(phi), s * sinf(phi), z)).x;
        by_surfaces += e * e / (9.8696044 * STEPS * STEPS);
    }
    assert_float_equal(by_code, by_surfaces, 0.002 * by_surfaces); /* the midpoint rule over 60 rings */
}

static double loss_at(nn_program *p, nn_params *params)
{
    nn_params_touch(params);
    assert_int_equal(nn_forward(p), OK);
    return (double)nn_total_loss(p);
}

/* Returns the slope of the loss along a unit direction by central differences, with the h⁴ term of Richardson. */
static double slope(nn_program *p, nn_params *params, nn_param *q, const float *direction, float h)
{
    static const float steps[4] = {-2, -1, 1, 2};
    double loss[4];
    float *kept = malloc(q->count * sizeof *kept);
    assert_non_null(kept);
    memcpy(kept, q->value, q->count * sizeof *kept);
    for (int k = 0; k < 4; k++) {
        for (size_t i = 0; i < q->count; i++)
            q->value[i] = kept[i] + steps[k] * h * direction[i];
        loss[k] = loss_at(p, params);
    }
    memcpy(q->value, kept, q->count * sizeof *kept);
    free(kept);
    return (8 * (loss[2] - loss[1]) - (loss[3] - loss[0])) / (12 * (double)h);
}

/* Along the gradient the slope is its length. The total loss is near 10 and a float (rounding 1e-6): at steps of 1e-3
 * that is 1e-3 of slope; the rest is due to the many kinks of ReLU between two steps. */
static void gradients_of_the_whole_network_match_finite_differences(void **unused)
{
    (void)unused;
    static const char *const names[] = {"environment.fc1.weight", "environment.fc2.weight",      "environment.fc2.bias",
                                        "lighting.fc1.weight",    "material.head.weight",        "indirect.head.weight",
                                        "relight.head.weight",    "encoder.level4.c.conv.weight"};
    nn_params *params = NULL;
    nn_program *p = compile(&both, MODEL_TRAINING_SSIM, NN_TRAIN, &params);
    fill_inputs(p);
    fill_targets(p);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        nn_param *q = nn_params_find(params, names[i]);
        if (!q) fail_msg("no parameter %s", names[i]);
        loss_at(p, params);
        assert_int_equal(nn_backward(p), OK);
        double length = 0;
        for (size_t k = 0; k < q->count; k++)
            length += (double)q->gradient[k] * (double)q->gradient[k];
        length = sqrt(length);
        assert_true(length > 1e-3);
        float *direction = malloc(q->count * sizeof *direction);
        assert_non_null(direction);
        for (size_t k = 0; k < q->count; k++)
            direction[k] = (float)((double)q->gradient[k] / length);
        double measured = slope(p, params, q, direction, 1e-3f);
        free(direction);
        if (!(fabs(measured - length) < 0.02 * length + 5e-3))
            fail_msg("%s: gradient %g, finite difference %g", names[i], length, measured);
    }
    nn_program_free(p);
    nn_params_free(params);
}

static void losses_know_the_environment(void **unused)
{
    (void)unused;
    nn_params *params = NULL;
    nn_program *p = compile(&both, MODEL_TRAINING, NN_TRAIN, &params);
    fill_inputs(p);
    fill_targets(p);
    assert_int_equal(nn_forward(p), OK);
    const float *code = nn_output_data(p, "environment_code"), *wanted = nn_input_data(p, "environment_true");
    double sum = 0;
    for (int i = 0; i < BATCH * MODEL_SH; i++)
        sum += pow((double)code[i] - (double)wanted[i], 2) / BATCH;
    assert_float_equal(nn_loss(p, "environment"), sum, 1e-5 * sum);
    nn_program_free(p);
    nn_params_free(params);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(model_of_both_lights_has_its_names),
        cmocka_unit_test(environment_is_that_of_its_code),
        cmocka_unit_test(code_is_decoded_to_what_was_encoded),
        cmocka_unit_test(squared_code_is_the_mean_square_of_white_surfaces),
        cmocka_unit_test(gradients_of_the_whole_network_match_finite_differences),
        cmocka_unit_test(losses_know_the_environment),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
