/* SPDX-License-Identifier: MIT */
/* Winograd's filtering against convolutions by their definition in double precision, and steps of a program computed by
 * it against differences. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/half.h"
#include "base/rng.h"
#include "nn/cpu/winograd/winograd.h"
#include "nn/nn.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

static float *new_floats(size_t count, uint64_t stream)
{
    float *x = malloc(count * sizeof *x);
    assert_non_null(x);
    rng random = rng_at(5, 0, stream);
    for (size_t i = 0; i < count; i++)
        x[i] = rng_range(&random, -1, 1);
    return x;
}

/* Returns the room of `count` floats with the numbers in a type, to which the floats are rounded. */
static void *new_numbers(float *x, size_t count, nn_type type)
{
    float *room = malloc(count * sizeof *room);
    assert_non_null(room);
    uint16_t *narrow = (uint16_t *)room;
    for (size_t i = 0; i < count; i++) {
        if (type == NN_FLOAT32)
            room[i] = x[i];
        else
            x[i] = bf16_to_float(narrow[i] = float_to_bf16(x[i]));
    }
    return room;
}

static void numbers_to_floats(const void *numbers, size_t count, nn_type type, float *to)
{
    for (size_t i = 0; i < count; i++)
        to[i] = type == NN_FLOAT32 ? ((const float *)numbers)[i] : bf16_to_float(((const uint16_t *)numbers)[i]);
}

/* A convolution's data. x_in, y_in and dy_in are in its types, with x, y and dy as values. */
typedef struct fixture {
    winograd g;
    size_t inputs, outputs, taps;
    float *x, *y, *dy, *weight, *bias, *u, *room;
    void *x_in, *y_in, *dy_in;
} fixture;

static fixture open_fixture(winograd g)
{
    size_t pixels = (size_t)g.n * (size_t)g.h * (size_t)g.w, in = (size_t)g.in, out = (size_t)g.out;
    fixture f = {.g = g, .inputs = pixels * in, .outputs = pixels * out, .taps = 9 * in * out};
    const winograd back = winograd_back(&g);
    size_t rooms[] = {winograd_room(&g), winograd_room(&back), winograd_gradient_room(&g)}, most = 0;
    for (int i = 0; i < 3; i++)
        most = rooms[i] > most ? rooms[i] : most;
    f.x = new_floats(f.inputs, 1);
    f.y = new_floats(f.outputs, 2);
    f.dy = new_floats(f.outputs, 3);
    f.weight = new_floats(f.taps, 4);
    f.bias = new_floats(out, 5);
    f.u = new_floats(winograd_weights(g.in, g.out), 6);
    f.room = new_floats(most, 7);
    f.x_in = new_numbers(f.x, f.inputs, g.from);
    f.y_in = new_numbers(f.y, f.outputs, g.to);
    f.dy_in = new_numbers(f.dy, f.outputs, g.to);
    return f;
}

static void close_fixture(fixture *f)
{
    void *all[] = {f->x, f->y, f->dy, f->weight, f->bias, f->u, f->room, f->x_in, f->y_in, f->dy_in};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        free(all[i]);
}

static size_t place(const winograd *g, int n, int y, int x)
{
    return ((size_t)n * (size_t)g->h + (size_t)y) * (size_t)g->w + (size_t)x;
}

static double weight_at(const fixture *f, int o, int i, int tap)
{
    return (double)f->weight[(o * f->g.in + i) * 9 + tap];
}

/* A function called for every pair of pixels that a tap joins: a convolution and both its gradients are sums over
 * these. */
typedef void (*visit)(const fixture *f, size_t from, size_t to, int tap, double *sums);

static void for_all_pairs(const fixture *f, visit what, double *sums)
{
    const winograd *g = &f->g;
    for (int n = 0; n < g->n; n++)
        for (int y = 0; y < g->h; y++)
            for (int x = 0; x < g->w; x++)
                for (int tap = 0; tap < 9; tap++) {
                    int py = y + tap / 3 - 1, px = x + tap % 3 - 1;
                    if (py >= 0 && py < g->h && px >= 0 && px < g->w)
                        what(f, place(g, n, py, px), place(g, n, y, x), tap, sums);
                }
}

static void add_output(const fixture *f, size_t from, size_t to, int tap, double *sums)
{
    for (int o = 0; o < f->g.out; o++)
        for (int i = 0; i < f->g.in; i++)
            sums[to * (size_t)f->g.out + (size_t)o] +=
                weight_at(f, o, i, tap) * (double)f->x[from * (size_t)f->g.in + (size_t)i];
}

static void add_input_gradient(const fixture *f, size_t from, size_t to, int tap, double *sums)
{
    for (int o = 0; o < f->g.out; o++)
        for (int i = 0; i < f->g.in; i++)
            sums[from * (size_t)f->g.in + (size_t)i] +=
                weight_at(f, o, i, tap) * (double)f->dy[to * (size_t)f->g.out + (size_t)o];
}

static void add_weight_gradient(const fixture *f, size_t from, size_t to, int tap, double *sums)
{
    for (int o = 0; o < f->g.out; o++)
        for (int i = 0; i < f->g.in; i++)
            sums[(o * f->g.in + i) * 9 + tap] +=
                (double)f->dy[to * (size_t)f->g.out + (size_t)o] * (double)f->x[from * (size_t)f->g.in + (size_t)i];
}

/* Asserts a root mean square error relative to the root mean square. Sums of thousands of products of 24 bits, which
 * filtering makes some ten times less exact: 1e-5; rounded to the 8 bits of bfloat16, 2^-9 at most. */
static void assert_close(const void *numbers, const double *expected, size_t count, nn_type type)
{
    double error = 0, square = 0, bound = type == NN_FLOAT32 ? 1e-5 : 0.002;
    float *found = malloc(count * sizeof *found);
    assert_non_null(found);
    numbers_to_floats(numbers, count, type, found);
    for (size_t i = 0; i < count; i++) {
        error += pow((double)found[i] - expected[i], 2);
        square += expected[i] * expected[i];
    }
    free(found);
    if (!(sqrt(error / square) < bound)) fail_msg("relative error %g", sqrt(error / square));
}

static double *new_sums(size_t count)
{
    double *sums = calloc(count, sizeof *sums);
    assert_non_null(sums);
    return sums;
}

/* Shapes with whole tiles and not, fewer than a thread's share, more channels in than out and the other way round. */
static const winograd shapes[] = {
    {2, 16, 24, 16, 32, 2, NN_FLOAT32, NN_FLOAT32}, {3, 7, 10, 48, 16, 3, NN_FLOAT32, NN_FLOAT32},
    {1, 1, 1, 16, 16, 2, NN_FLOAT32, NN_FLOAT32},   {1, 13, 5, 160, 16, 2, NN_FLOAT32, NN_FLOAT32},
    {1, 4, 9, 16, 176, 1, NN_FLOAT32, NN_FLOAT32},  {2, 3, 2, 32, 32, 4, NN_FLOAT32, NN_FLOAT32},
    {2, 40, 37, 16, 16, 2, NN_FLOAT32, NN_FLOAT32}, {2, 17, 22, 48, 80, 2, NN_BFLOAT16, NN_BFLOAT16},
    {1, 30, 7, 32, 16, 2, NN_BFLOAT16, NN_FLOAT32}};
enum { SHAPES = sizeof shapes / sizeof *shapes };

static void convolution_matches_the_definition(void **state)
{
    (void)state;
    for (int k = 0; k < SHAPES; k++) {
        fixture f = open_fixture(shapes[k]);
        double *sums = new_sums(f.outputs);
        for_all_pairs(&f, add_output, sums);
        winograd_transform(f.weight, f.g.in, f.g.out, f.u);
        winograd_convolve(&f.g, f.x_in, f.u, &(winograd_after){0}, f.y_in, f.room);
        assert_close(f.y_in, sums, f.outputs, f.g.to);
        free(sums);
        close_fixture(&f);
    }
}

/* The picture that is added has the input's type, which may differ from the output's. */
static void bias_a_picture_old_values_and_relu_come_after_the_sums(void **state)
{
    (void)state;
    for (int k = 0; k < SHAPES; k++) {
        fixture f = open_fixture(shapes[k]);
        double *sums = new_sums(f.outputs);
        float *beside = new_floats(f.outputs, 8);
        void *beside_in = new_numbers(beside, f.outputs, f.g.from);
        for_all_pairs(&f, add_output, sums);
        for (size_t i = 0; i < f.outputs; i++)
            sums[i] = fmax(sums[i] + (double)f.bias[i % (size_t)f.g.out] + (double)beside[i] + (double)f.y[i], 0);
        winograd_transform(f.weight, f.g.in, f.g.out, f.u);
        winograd_after after = {.bias = f.bias, .beside = beside_in, .relu = true, .accumulate = true};
        winograd_convolve(&f.g, f.x_in, f.u, &after, f.y_in, f.room);
        assert_close(f.y_in, sums, f.outputs, f.g.to);
        free(beside);
        free(beside_in);
        free(sums);
        close_fixture(&f);
    }
}

/* Rounding is float_to_bf16's: ties to even, infinity stays, NaN is NaN. */
static void bfloat16_is_rounded_as_everywhere(void **state)
{
    (void)state;
    enum { CASES = 8 };
    const float cases[CASES] = {1.00390625f, 1.01171875f, -1.0e-40f, INFINITY, -INFINITY, NAN, 3.3999e38f, 0.3333333f};
    winograd g = {1, 1, 1, 16, 16, 1, NN_FLOAT32, NN_BFLOAT16};
    fixture f = open_fixture(g);
    memset(f.u, 0, winograd_weights(16, 16) * sizeof *f.u);
    for (int i = 0; i < 16; i++)
        f.bias[i] = cases[i % CASES];
    winograd_convolve(&f.g, f.x_in, f.u, &(winograd_after){.bias = f.bias}, f.y_in, f.room);
    const uint16_t *y = f.y_in;
    for (int i = 0; i < 16; i++) {
        uint16_t expected = float_to_bf16(cases[i % CASES]);
        if (y[i] != expected) fail_msg("%g is %#x, not %#x", (double)cases[i % CASES], y[i], expected);
    }
    close_fixture(&f);
}

static void input_gradient_matches_the_definition(void **state)
{
    (void)state;
    for (int k = 0; k < SHAPES; k++) {
        fixture f = open_fixture(shapes[k]);
        double *sums = new_sums(f.inputs);
        const winograd back = winograd_back(&f.g);
        for_all_pairs(&f, add_input_gradient, sums);
        winograd_transform_back(f.weight, f.g.in, f.g.out, f.u);
        winograd_convolve(&back, f.dy_in, f.u, &(winograd_after){0}, f.x_in, f.room);
        assert_close(f.x_in, sums, f.inputs, f.g.from);
        free(sums);
        close_fixture(&f);
    }
}

static void weight_gradient_matches_the_definition(void **state)
{
    (void)state;
    for (int k = 0; k < SHAPES; k++) {
        fixture f = open_fixture(shapes[k]);
        double *sums = new_sums(f.taps);
        for_all_pairs(&f, add_weight_gradient, sums);
        winograd_gradient(&f.g, f.x_in, f.dy_in, f.weight, f.room);
        assert_close(f.weight, sums, f.taps, NN_FLOAT32);
        free(sums);
        close_fixture(&f);
    }
}

static void threads_change_no_bit(void **state)
{
    (void)state;
    winograd one = {2, 18, 30, 32, 48, 1, NN_FLOAT32, NN_FLOAT32}, three = one;
    three.threads = 3;
    fixture a = open_fixture(one), b = open_fixture(three);
    for (int k = 0; k < 2; k++) {
        fixture *f = k ? &b : &a;
        winograd_transform(f->weight, f->g.in, f->g.out, f->u);
        winograd_convolve(&f->g, f->x_in, f->u, &(winograd_after){0}, f->y_in, f->room);
        winograd_gradient(&f->g, f->x_in, f->dy_in, f->weight, f->room);
    }
    assert_memory_equal(a.y_in, b.y_in, a.outputs * sizeof *a.y);
    assert_memory_equal(a.weight, b.weight, a.taps * sizeof *a.weight);
    close_fixture(&a);
    close_fixture(&b);
}

/* ---- in a program ---- */

enum { SIZE = 48, BATCH = 2, CHANNELS = 16 };

/* Builds a stem whose output two convolutions use, with ReLU and bias, with batch norm and without. */
static nn_graph *build_net(void)
{
    nn_graph *g = nn_graph_new();
    nn_node *x = nn_conv2d(g, nn_compute(g, nn_input(g, "x", 3, 1)), "stem", CHANNELS, 3, 1, NN_BIAS);
    nn_node *a = nn_relu(g, nn_conv2d(g, x, "a", 2 * CHANNELS, 3, 1, NN_BIAS));
    a = nn_conv2d(g, a, "b", CHANNELS, 3, 1, NN_BIAS);
    nn_node *c = nn_batch_norm(g, nn_conv2d(g, x, "c", CHANNELS, 3, 1, NN_NO_BIAS), "norm");
    nn_node *y = nn_float(g, nn_add(g, a, c));
    nn_output(g, y, "y");
    nn_masked_l2(g, y, nn_input(g, "target", CHANNELS, 1), nn_input(g, "mask", 1, 1), "loss", 1);
    return g;
}

static nn_program *compile(nn_params *params, nn_purpose purpose, int size, nn_type type)
{
    nn_graph *g = build_net();
    nn_program *p;
    const nn_options options = {.batch = BATCH, .height = size, .width = size, .type = type, .purpose = purpose};
    if (nn_compile(g, params, &options, &p) != OK) fail_msg("%s", status_message());
    nn_graph_free(g);
    const char *names[] = {"x", "target", "mask"};
    const size_t counts[] = {3, CHANNELS, 1};
    for (int i = 0; i < 3; i++) {
        size_t count = (size_t)(BATCH * size * size) * counts[i];
        float *values = new_floats(count, (uint64_t)(10 + i));
        memcpy(nn_input_data(p, names[i]), values, count * sizeof *values);
        free(values);
    }
    return p;
}

static double loss_at(nn_params *params, nn_program *p, nn_param *w, const float *was, double along)
{
    for (size_t i = 0; i < w->count; i++)
        w->value[i] = (float)((double)was[i] + along * (double)w->gradient[i]);
    nn_params_touch(params);
    assert_int_equal(nn_forward(p), OK);
    return (double)nn_loss(p, "loss");
}

/* Along a parameter's gradient the loss grows by its square. */
static void gradients_of_a_program_match_differences(void **state)
{
    (void)state;
    nn_params *params;
    nn_graph *g = build_net();
    assert_int_equal(nn_params_new(g, 3, &params), OK);
    nn_graph_free(g);
    nn_program *p = compile(params, NN_TRAIN, SIZE, NN_FLOAT32);
    const char *names[] = {"stem.weight", "a.weight", "a.bias", "b.weight", "b.bias", "c.weight"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        nn_param *w = nn_params_find(params, names[k]);
        float *was = malloc(w->count * sizeof *was);
        assert_non_null(was);
        memcpy(was, w->value, w->count * sizeof *was);
        assert_int_equal(nn_forward(p), OK);
        assert_int_equal(nn_backward(p), OK);
        double square = 0;
        for (size_t i = 0; i < w->count; i++)
            square += (double)w->gradient[i] * (double)w->gradient[i];
        double step = 0.02 / sqrt(square); /* far enough for a float32 loss, near enough for ReLU's kinks */
        double slope = (loss_at(params, p, w, was, step) - loss_at(params, p, w, was, -step)) / (2 * step);
        if (!(fabs(slope / square - 1) < 1e-3)) fail_msg("%s: %g, expected %g", names[k], square, slope);
        memcpy(w->value, was, w->count * sizeof *was);
        nn_params_touch(params);
        free(was);
    }
    nn_program_free(p);
    nn_params_free(params);
}

/* With activations of 8 bits gradients are right to a few hundredths. */
static void gradients_in_bfloat16_are_nearly_those_in_float32(void **state)
{
    (void)state;
    nn_params *params[2];
    for (int k = 0; k < 2; k++) {
        nn_graph *g = build_net();
        assert_int_equal(nn_params_new(g, 3, &params[k]), OK);
        nn_graph_free(g);
        nn_program *p = compile(params[k], NN_TRAIN, SIZE, k ? NN_BFLOAT16 : NN_FLOAT32);
        assert_int_equal(nn_forward(p), OK);
        assert_int_equal(nn_backward(p), OK);
        nn_program_free(p);
    }
    for (size_t i = 0; i < nn_params_count(params[0]); i++) {
        const nn_param *exact = nn_params_at(params[0], i), *rounded = nn_params_at(params[1], i);
        double square = 0, error = 0;
        for (size_t j = 0; exact->gradient && j < exact->count; j++) {
            square += pow((double)exact->gradient[j], 2);
            error += pow((double)rounded->gradient[j] - (double)exact->gradient[j], 2);
        }
        if (!(sqrt(error) <= 0.03 * sqrt(square) + 1e-6))
            fail_msg("%s: %g of %g", exact->name, sqrt(error), sqrt(square));
    }
    nn_params_free(params[0]);
    nn_params_free(params[1]);
}

/* Far from a picture's border results do not depend on its size. The smaller picture has too few tiles for filtering:
 * oneDNN computes it, with batch norm folded into its weights as well. */
static void a_program_agrees_with_one_of_another_size(void **state)
{
    (void)state;
    enum { SMALL = 16, MIDDLE = 8 };
    nn_params *params;
    nn_graph *g = build_net();
    assert_int_equal(nn_params_new(g, 3, &params), OK);
    nn_graph_free(g);
    nn_param *mean = nn_params_find(params, "norm.running_mean"), *scale = nn_params_find(params, "norm.weight");
    for (size_t i = 0; i < mean->count; i++) {
        mean->value[i] = 0.05f * (float)i - 0.3f;
        scale->value[i] = 1.5f - 0.1f * (float)i;
    }
    nn_params_touch(params);
    nn_program *large = compile(params, NN_INFER, SIZE, NN_FLOAT32),
               *small = compile(params, NN_INFER, SMALL, NN_FLOAT32);
    for (int y = 0; y < SMALL; y++)
        memcpy(nn_input_data(small, "x") + y * SMALL * 3, nn_input_data(large, "x") + y * SIZE * 3,
               SMALL * 3 * sizeof(float));
    assert_int_equal(nn_forward(large), OK);
    assert_int_equal(nn_forward(small), OK);
    const float *a = nn_output_data(large, "y"), *b = nn_output_data(small, "y");
    for (int y = 0; y < MIDDLE; y++)
        for (int x = 0; x < MIDDLE * CHANNELS; x++)
            assert_float_equal(a[y * SIZE * CHANNELS + x], b[y * SMALL * CHANNELS + x], 2e-5);
    nn_program_free(large);
    nn_program_free(small);
    nn_params_free(params);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(convolution_matches_the_definition),
        cmocka_unit_test(bias_a_picture_old_values_and_relu_come_after_the_sums),
        cmocka_unit_test(bfloat16_is_rounded_as_everywhere),
        cmocka_unit_test(input_gradient_matches_the_definition),
        cmocka_unit_test(weight_gradient_matches_the_definition),
        cmocka_unit_test(threads_change_no_bit),
        cmocka_unit_test(gradients_of_a_program_match_differences),
        cmocka_unit_test(gradients_in_bfloat16_are_nearly_those_in_float32),
        cmocka_unit_test(a_program_agrees_with_one_of_another_size),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
