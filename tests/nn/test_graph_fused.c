/* SPDX-License-Identifier: MIT */
/* Operations fused into a convolution give the results of the separate steps. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include "nn/nn.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

enum { CHANNELS = 16, SMALL = 8, LARGE = 64 };

/* Builds a residual block, a sum whose second convolution is built first, one of a value with itself and one after
 * ReLU. With "a", "b", "c" and "d" as outputs every step is separate. */
static nn_graph *build_net(int kernel)
{
    nn_graph *g = nn_graph_new();
    nn_node *x = nn_conv2d(g, nn_compute(g, nn_input(g, "x", 3, 1)), "stem", CHANNELS, 3, 1, NN_BIAS);
    nn_node *a = nn_batch_norm(g, nn_conv2d(g, x, "a", CHANNELS, kernel, 1, NN_NO_BIAS), "norm");
    nn_node *block = nn_add(g, x, a);
    nn_node *b = nn_conv2d(g, block, "b", CHANNELS, kernel, 1, NN_BIAS);
    nn_node *c = nn_conv2d(g, x, "c", CHANNELS, kernel, 1, NN_BIAS);
    nn_node *both = nn_relu(g, nn_add(g, c, b));
    nn_node *d = nn_relu(g, nn_conv2d(g, both, "d", CHANNELS, kernel, 1, NN_BIAS));
    nn_node *e = nn_conv2d(g, nn_add(g, d, both), "e", CHANNELS, kernel, 1, NN_BIAS);
    nn_output(g, nn_float(g, nn_add(g, e, nn_add(g, e, block))), "y");
    nn_node *parts[] = {a, b, c, d, e};
    const char *names[] = {"a", "b", "c", "d", "e"};
    for (int i = 0; i < 5; i++)
        nn_output(g, nn_float(g, parts[i]), names[i]);
    return g;
}

static float *run(const nn_graph *g, nn_params *params, nn_type type, int size, const char *const *outputs)
{
    const nn_options options = {.batch = 2, .height = size, .width = size, .type = type, .outputs = outputs};
    nn_program *p;
    if (nn_compile(g, params, &options, &p) != OK) fail_msg("%s", status_message());
    float *x = nn_input_data(p, "x"), *y = malloc((size_t)(2 * size * size * CHANNELS) * sizeof *y);
    assert_non_null(y);
    for (int i = 0; i < 2 * size * size * 3; i++)
        x[i] = sinf(0.7f * (float)i);
    assert_int_equal(nn_forward(p), OK);
    for (int i = 0; i < 2 * size * size * CHANNELS; i++)
        y[i] = nn_output_data(p, "y")[i];
    nn_program_free(p);
    return y;
}

/* Returns the root mean square difference over the root mean square. */
static double difference(const float *a, const float *b, size_t count)
{
    double error = 0, square = 0;
    for (size_t i = 0; i < count; i++) {
        error += pow((double)a[i] - (double)b[i], 2);
        square += pow((double)b[i], 2);
    }
    return sqrt(error / square);
}

/* A small picture's convolutions are oneDNN's, a large one's the project's own. */
static void sums_behind_convolutions_are_what_they_are_by_themselves(void **state)
{
    (void)state;
    static const char *const alone[] = {"y", NULL};
    for (int k = 0; k < 8; k++) {
        const int kernel = k & 1 ? 3 : 1, size = k & 2 ? LARGE : SMALL;
        const nn_type type = k & 4 ? NN_BFLOAT16 : NN_FLOAT32;
        nn_graph *g = build_net(kernel);
        nn_params *params;
        assert_int_equal(nn_params_new(g, 3, &params), OK);
        nn_param *mean = nn_params_find(params, "norm.running_mean");
        for (size_t i = 0; i < mean->count; i++)
            mean->value[i] = 0.1f * (float)i - 0.5f;
        nn_params_touch(params);
        float *fused = run(g, params, type, size, alone), *apart = run(g, params, type, size, NULL);
        double off = difference(fused, apart, (size_t)(2 * size * size * CHANNELS));
        double bound = type == NN_FLOAT32 ? 1e-5 : 0.01; /* sums in between are rounded to 8 bits */
        if (!(off < bound)) fail_msg("kernel %d, size %d, type %d: %g", kernel, size, (int)type, off);
        free(fused);
        free(apart);
        nn_params_free(params);
        nn_graph_free(g);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sums_behind_convolutions_are_what_they_are_by_themselves),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
