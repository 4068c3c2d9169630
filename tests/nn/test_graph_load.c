/* SPDX-License-Identifier: MIT */
/* Parameters from safetensors files: all are loaded or none. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <setjmp.h>

#include "base/half.h"
#include "nn/nn.h"
#include "nn/safetensors.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

enum { MOST = 16 };

static char path[] = "/tmp/merlin-test-XXXXXX";

static nn_graph *build_net(void)
{
    nn_graph *g = nn_graph_new();
    nn_node *x = nn_conv2d(g, nn_compute(g, nn_input(g, "x", 3, 1)), "conv", 4, 3, 1, NN_BIAS);
    nn_batch_norm(g, x, "norm");
    return g;
}

static nn_params *new_params(uint64_t seed)
{
    nn_graph *g = build_net();
    nn_params *params;
    assert_int_equal(nn_params_new(g, seed, &params), OK);
    nn_graph_free(g);
    return params;
}

/* Describes all parameters; returns how many. */
static size_t describe(nn_params *params, safetensors_tensor *tensors)
{
    size_t count = nn_params_count(params);
    for (size_t i = 0; i < count; i++) {
        const nn_param *p = nn_params_at(params, i);
        tensors[i] = (safetensors_tensor){
            .name = p->name, .type = SAFETENSORS_F32, .rank = p->rank, .count = p->count, .data = p->value};
        memcpy(tensors[i].shape, p->shape, sizeof p->shape);
    }
    return count;
}

static void saved_parameters_are_loaded(void **state)
{
    (void)state;
    nn_params *a = new_params(1), *b = new_params(2);
    safetensors_tensor tensors[MOST];
    assert_int_equal(safetensors_write(path, tensors, describe(a, tensors), NULL, 0), OK);
    assert_int_equal(nn_params_load(b, path), OK);
    for (size_t i = 0; i < nn_params_count(a); i++)
        assert_memory_equal(nn_params_at(a, i)->value, nn_params_at(b, i)->value,
                            nn_params_at(a, i)->count * sizeof(float));
    nn_params_free(a);
    nn_params_free(b);
}

/* Writes the tensors and loads them into other parameters, which must be refused with these words and stay unchanged.
 */
static void assert_refused(const safetensors_tensor *tensors, size_t count, const char *words)
{
    nn_params *b = new_params(2), *untouched = new_params(2);
    assert_int_equal(safetensors_write(path, tensors, count, NULL, 0), OK);
    assert_int_equal(nn_params_load(b, path), MERLIN_BAD_INPUT);
    if (!strstr(status_message(), words)) fail_msg("\"%s\" is not in \"%s\"", words, status_message());
    for (size_t i = 0; i < nn_params_count(b); i++)
        assert_memory_equal(nn_params_at(b, i)->value, nn_params_at(untouched, i)->value,
                            nn_params_at(b, i)->count * sizeof(float));
    nn_params_free(b);
    nn_params_free(untouched);
}

static void tensors_that_do_not_fit_are_refused(void **state)
{
    (void)state;
    nn_params *a = new_params(1);
    safetensors_tensor tensors[MOST];
    size_t count = describe(a, tensors);
    assert_refused(tensors, count - 1, "norm.running_var is missing");
    tensors[count] = tensors[0];
    tensors[count].name = "stranger";
    assert_refused(tensors, count + 1, "stranger");
    describe(a, tensors);
    tensors[0].shape[0] = 3;
    tensors[0].shape[1] = 4;
    assert_refused(tensors, count, "conv.weight has another shape");
    nn_params_free(a);
}

static void tensors_that_fit_are_shared_and_the_rest_stays(void **state)
{
    (void)state;
    nn_params *a = new_params(1), *b = new_params(2), *before = new_params(2);
    safetensors_tensor tensors[MOST];
    size_t count = describe(a, tensors);
    /* an unknown tensor, a missing one, one of another shape */
    tensors[0].shape[0] = 3;
    tensors[0].shape[1] = 4;
    tensors[1].name = "stranger";
    nn_params_at(a, 2)->value[0] = 42;
    assert_int_equal(safetensors_write(path, tensors, count, NULL, 0), OK);
    assert_int_equal(nn_params_load_shared(b, path), OK);
    for (size_t i = 0; i < count; i++) {
        const nn_param *expected = nn_params_at(i < 2 ? before : a, i);
        assert_memory_equal(nn_params_at(b, i)->value, expected->value, expected->count * sizeof(float));
    }
    assert_true(nn_params_at(b, 2)->value[0] == 42);
    assert_int_equal(safetensors_write(path, tensors, 2, NULL, 0), OK);
    assert_int_equal(nn_params_load_shared(b, path), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "no tensor fits"));
    nn_params_free(a);
    nn_params_free(b);
    nn_params_free(before);
}

/* ---- parameters for inference ---- */

enum { SIZE = 32, CHANNELS = 16, MOST_WEIGHTS = CHANNELS * CHANNELS * 9 };

/* Builds a convolution with a batch norm to fold, one with only a bias, and one with neither. */
static nn_graph *build_deep_net(void)
{
    nn_graph *g = nn_graph_new();
    nn_node *x = nn_conv2d(g, nn_compute(g, nn_input(g, "x", CHANNELS, 1)), "folded", CHANNELS, 3, 1, NN_NO_BIAS);
    x = nn_relu(g, nn_batch_norm(g, x, "norm"));
    x = nn_conv2d(g, nn_conv2d(g, x, "bare", CHANNELS, 1, 1, NN_NO_BIAS), "head", CHANNELS, 3, 1, NN_BIAS);
    nn_output(g, nn_float(g, x), "y");
    return g;
}

/* Writes weights as half floats, every other one of them below the smallest normal half. */
static void write_halves(const nn_graph *g)
{
    static uint16_t halves[3][MOST_WEIGHTS];
    nn_params *a;
    safetensors_tensor tensors[MOST];
    assert_int_equal(nn_params_new(g, 1, &a), OK);
    size_t count = describe(a, tensors), used = 0;
    for (size_t i = 0; i < count; i++) {
        if (tensors[i].rank != 4) continue;
        const float *from = tensors[i].data;
        uint16_t *to = halves[used++];
        for (size_t k = 0; k < tensors[i].count; k++)
            to[k] = float_to_half(k % 2 ? from[k] * 1e-5f : from[k]);
        tensors[i].type = SAFETENSORS_F16;
        tensors[i].data = to;
    }
    assert_int_equal(used, 3);
    assert_int_equal(safetensors_write(path, tensors, count, NULL, 0), OK);
    nn_params_free(a);
}

static void run(const nn_graph *g, nn_params *params, nn_type type, float *y)
{
    nn_program *p;
    nn_options options = {.batch = 1, .height = SIZE, .width = SIZE, .type = type};
    assert_int_equal(nn_compile(g, params, &options, &p), OK);
    float *x = nn_input_data(p, "x");
    for (int i = 0; i < SIZE * SIZE * CHANNELS; i++)
        x[i] = (float)(i % 23) / 23 - 0.4f;
    assert_int_equal(nn_forward(p), OK);
    memcpy(y, nn_output_data(p, "y"), SIZE * SIZE * CHANNELS * sizeof *y);
    nn_program_free(p);
}

static void weights_kept_as_half_floats_give_the_same_bits(void **state)
{
    (void)state;
    static float of_floats[SIZE * SIZE * CHANNELS], of_halves[SIZE * SIZE * CHANNELS];
    nn_graph *g = build_deep_net();
    nn_params *floats, *halves;
    safetensors_file *f;
    write_halves(g);
    assert_int_equal(nn_params_new(g, 2, &floats), OK);
    assert_int_equal(nn_params_load(floats, path), OK);
    assert_int_equal(safetensors_open(path, &f), OK);
    assert_int_equal(nn_params_open(g, f, path, &halves), OK);
    safetensors_close(f);
    for (size_t i = 0; i < nn_params_count(halves); i++)
        assert_true((nn_params_at(halves, i)->half != NULL) == (nn_params_at(halves, i)->rank == 4));
    for (int type = NN_FLOAT32; type <= NN_BFLOAT16; type++) {
        run(g, floats, (nn_type)type, of_floats);
        run(g, halves, (nn_type)type, of_halves);
        assert_memory_equal(of_floats, of_halves, sizeof of_floats);
        assert_true(of_halves[SIZE * SIZE] != 0);
    }
    nn_program *p;
    nn_options train = {.batch = 2, .height = SIZE, .width = SIZE, .purpose = NN_TRAIN};
    assert_int_equal(nn_compile(g, halves, &train, &p), MERLIN_WRONG_USE);
    assert_non_null(strstr(status_message(), "not for training"));
    nn_params_free(floats);
    nn_params_free(halves);
    nn_graph_free(g);
}

static int make_file(void **state)
{
    (void)state;
    int file = mkstemp(path);
    return file < 0 ? -1 : close(file);
}

static int remove_file(void **state)
{
    (void)state;
    return remove(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(saved_parameters_are_loaded),
        cmocka_unit_test(tensors_that_do_not_fit_are_refused),
        cmocka_unit_test(tensors_that_fit_are_shared_and_the_rest_stays),
        cmocka_unit_test(weights_kept_as_half_floats_give_the_same_bits),
    };
    return cmocka_run_group_tests(tests, make_file, remove_file);
}
