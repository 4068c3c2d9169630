/* SPDX-License-Identifier: MIT */
/* Compares the whole network with PyTorch in double precision: tests/reference/make_reference.py writes the vectors and
 * documents them.
 *
 * Tolerances. Float32 rounds at 6e-8; some fifty layers of sums over a hundred products, and batch norms over as few as
 * eight values, leave about 1e-5 of an output and 1e-4 of a gradient. A gradient also jumps wherever rounding carries
 * one of the 10^5 rectified or clipped values across its kink, so that gradients are compared as vectors. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/model.h"
#include "reference.h"

enum { SIZE = 64, BATCH = 2, STRIDE = 8, WIDTH = 8 };
static const float rate = 0.01f;

/* ---- inputs and parameters ---- */

typedef struct input {
    const char *name;
    int channels;
    double scale, shift;
} input;

static const input images[] = {
    {"image", 3, 0.5, 0.5},         {"albedo_true", 3, 1, 0},    {"roughness_true", 1, 1, 0},
    {"normal_true", 3, 1, 0},       {"depth_true", 1, 0.1, 1},   {"direct_true", 3, 0.5, 0.5},
    {"indirect_true", 3, .05, .05}, {"relit_true", 3, 0.5, 0.5}, {"reconstruction_true", 3, 0.5, 0.5},
};

static void fill_inputs(nn_program *p)
{
    float *mask = nn_input_data(p, "mask"), *loss_mask = nn_input_data(p, "loss_mask");
    reference_fill_disc(mask, BATCH, SIZE, 26);
    if (loss_mask) reference_fill_disc(loss_mask, BATCH, SIZE, 25);
    for (size_t i = 0; i < sizeof images / sizeof *images; i++) {
        float *to = nn_input_data(p, images[i].name);
        size_t count = (size_t)(BATCH * SIZE * SIZE * images[i].channels);
        if (to) reference_fill(to, images[i].name, count, images[i].scale, images[i].shift);
    }
    float *image = nn_input_data(p, "image"), *light = nn_input_data(p, "light");
    for (size_t i = 0; i < BATCH * SIZE * SIZE * 3; i++)
        image[i] *= mask[i / 3];
    if (light) reference_fill(light, "light", BATCH * 3, 1, 0);
    reference_fill(nn_input_data(p, "light_position"), "light_position", BATCH * 3, 0.5, 0);
}

/* ---- one variant ---- */

typedef struct session {
    model_config config;
    safetensors_file *reference;
    nn_graph *training, *whole;
    nn_params *params;
    nn_program *train, *infer;
    float *before; /* all parameters' values before the step, one after the other */
} session;

static model_config tiny(bool everything)
{
    model_config c = {.name = "tiny",
                      .material_decoders = everything ? 1 : 4,
                      .feature_sharing = everything,
                      .gated_attention = everything,
                      .global_illumination = everything,
                      .relight = everything ? MODEL_RELIGHT_NETWORK : MODEL_RELIGHT_BRDF,
                      .lighting = MODEL_LIGHT_POINT};
    static const int encoder_blocks[2][MODEL_LEVELS] = {{0, 1, 0, 0, 0}, {0, 0, 2, 0, 1}};
    static const int material_blocks[2][MODEL_LEVELS - 1] = {{0, 0, 1, 0}, {0, 1, 0, 0}};
    memcpy(c.encoder_blocks, encoder_blocks[everything], sizeof c.encoder_blocks);
    memcpy(c.material_blocks, material_blocks[everything], sizeof c.material_blocks);
    for (int i = 0; i < MODEL_LEVELS; i++)
        c.widths[i] = c.gi_widths[i] = WIDTH;
    return c;
}

static session session_new(bool everything)
{
    session s = {.config = tiny(everything)};
    const char *path = everything ? MERLIN_SOURCE_DIR "/tests/reference/merlin.safetensors"
                                  : MERLIN_SOURCE_DIR "/tests/reference/four_decoders.safetensors";
    nn_options options = {.batch = BATCH, .height = SIZE, .width = SIZE, .type = NN_FLOAT32, .purpose = NN_TRAIN};
    if (safetensors_open(path, &s.reference) != OK) fail_msg("%s", status_message());
    assert_int_equal(model_build(&s.config, MODEL_TRAINING, &s.training), OK);
    assert_int_equal(model_build(&s.config, MODEL_WHOLE, &s.whole), OK);
    assert_int_equal(nn_params_new(s.training, 1, &s.params), OK);
    reference_fill_params(s.params);
    if (nn_compile(s.training, s.params, &options, &s.train) != OK) fail_msg("%s", status_message());
    options.purpose = NN_INFER;
    if (nn_compile(s.whole, s.params, &options, &s.infer) != OK) fail_msg("%s", status_message());
    fill_inputs(s.train);
    fill_inputs(s.infer);
    return s;
}

static void session_free(session *s)
{
    nn_program_free(s->train), nn_program_free(s->infer);
    nn_params_free(s->params);
    nn_graph_free(s->training), nn_graph_free(s->whole);
    safetensors_close(s->reference);
    free(s->before);
}

static void compare_losses(const session *s, const char *kind, double tolerance)
{
    int count = 0;
    for (int i = 0; i < MODEL_LOSSES; i++) {
        float found = nn_loss(s->train, model_losses[i]);
        const safetensors_tensor *t = reference_stored(s->reference, kind, model_losses[i]);
        assert_true((t == NULL) == (isnan(found) != 0));
        if (t) reference_compare(s->reference, kind, model_losses[i], &found, tolerance), count++;
    }
    assert_true(count >= 7);
}

static void compare_gradients(const session *s, double tolerance)
{
    for (size_t i = 0; i < nn_params_count(s->params); i++) {
        const nn_param *p = nn_params_at(s->params, i);
        if (p->gradient) reference_compare(s->reference, "gradient", p->name, p->gradient, tolerance);
    }
}

static void keep_values(session *s)
{
    size_t total = 0;
    for (size_t i = 0; i < nn_params_count(s->params); i++)
        total += nn_params_at(s->params, i)->count;
    float *to = s->before = malloc(total * sizeof *to);
    assert_non_null(to);
    for (size_t i = 0; i < nn_params_count(s->params); i++) {
        const nn_param *p = nn_params_at(s->params, i);
        memcpy(to, p->value, p->count * sizeof *to);
        to += p->count;
    }
}

/* Steps are stored in half precision, accurate to 5e-4, and are differences of float32 values near one: 6e-8 of each,
 * which is 6e-6 after division by the rate, against steps of about 1e-2 for the smallest gradients. */
static void compare_steps(const session *s, double tolerance)
{
    float *before = s->before;
    for (size_t i = 0; i < nn_params_count(s->params); before += nn_params_at(s->params, i)->count, i++) {
        const nn_param *p = nn_params_at(s->params, i);
        if (!p->gradient || !reference_stored(s->reference, "step", p->name)) continue;
        for (size_t k = 0; k < p->count; k++)
            before[k] = (p->value[k] - before[k]) / rate;
        reference_compare(s->reference, "step", p->name, before, tolerance);
    }
}

static void compare_running(const session *s, double tolerance)
{
    for (size_t i = 0; i < nn_params_count(s->params); i++) {
        const nn_param *p = nn_params_at(s->params, i);
        if (!p->gradient) reference_compare(s->reference, "running", p->name, p->value, tolerance);
    }
}

static void compare_outputs(const session *s, double tolerance)
{
    static const char *const names[] = {"albedo", "normal",   "roughness",    "depth",
                                        "direct", "indirect", "relit_direct", "relit_brdf"};
    for (int k = 0; k < 8; k++)
        reference_compare_output(s->reference, "output", names[k], nn_output_data(s->infer, names[k]), SIZE, STRIDE,
                                 tolerance);
}

static void run_variant(bool everything)
{
    session s = session_new(everything);
    nn_adam_options options = {.beta1 = 0.9f, .beta2 = 0.999f, .epsilon = 1e-3f, .clip_norm = 1};
    nn_adam *adam = NULL;
    assert_int_equal(nn_adam_new(s.params, &options, &adam), OK);
    nn_params_scale_rate(s.params, "relight", 2);
    if (nn_forward(s.train) != OK) fail_msg("%s", status_message());
    float total = nn_total_loss(s.train);
    if (reference_distance(safetensors_find(s.reference, "total"), &total) > 1e-5)
        fail_msg("the total loss is %.9g", (double)total);
    compare_losses(&s, "loss", 2e-5);
    if (nn_backward(s.train) != OK) fail_msg("%s", status_message());
    compare_gradients(&s, 1e-3);
    keep_values(&s);
    assert_int_equal(nn_adam_step(adam, rate), OK);
    compare_steps(&s, 3e-3);
    assert_int_equal(nn_forward(s.train), OK);
    compare_losses(&s, "after", 1e-4);
    compare_running(&s, 1e-4);
    nn_params_touch(s.params);
    assert_int_equal(nn_forward(s.infer), OK);
    compare_outputs(&s, 1e-4);
    nn_adam_free(adam);
    session_free(&s);
}

static void merlin_trains_and_infers_as_in_pytorch(void **state)
{
    (void)state;
    run_variant(true);
}

static void four_decoders_train_and_infer_as_in_pytorch(void **state)
{
    (void)state;
    run_variant(false);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(merlin_trains_and_infers_as_in_pytorch),
        cmocka_unit_test(four_decoders_train_and_infer_as_in_pytorch),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
