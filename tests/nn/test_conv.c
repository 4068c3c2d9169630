/* SPDX-License-Identifier: MIT */
/* Compares convolutions and batch norm with loops in double precision that follow their definitions: values, and
 * gradients by central differences of these loops. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "base/rng.h"
#include "base/threads.h"
#include "nn/nn.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

enum { BATCH = 2, HEIGHT = 8, WIDTH = 12, INPUT = 3, LIMIT = 4096 };

typedef struct map {
    int n, h, w, c;
    double v[LIMIT];
} map;

static double *at(map *m, int n, int y, int x)
{
    return m->v + (((size_t)n * (size_t)m->h + (size_t)y) * (size_t)m->w + (size_t)x) * (size_t)m->c;
}

static const float *find(nn_params *params, const char *layer, const char *part)
{
    char name[64];
    snprintf(name, sizeof name, "%s.%s", layer, part);
    const nn_param *p = nn_params_find(params, name);
    return p ? p->value : NULL;
}

/* A change of one parameter by less than float can represent: this is added to one element. */
typedef struct nudge {
    const float *element;
    double amount;
} nudge;

static double value(const float *p, size_t i, const nudge *by)
{
    return (double)p[i] + (p + i == by->element ? by->amount : 0);
}

static void reference_dilated(nn_params *params, const nudge *by, const char *name, map *x, int out, int k, int stride,
                              int dilation, map *y)
{
    const float *w = find(params, name, "weight"), *b = find(params, name, "bias");
    *y = (map){.n = x->n, .h = x->h / stride, .w = x->w / stride, .c = out};
    int pad = (k - 1) * dilation / 2;
    for (int n = 0; n < y->n; n++)
        for (int oy = 0; oy < y->h; oy++)
            for (int ox = 0; ox < y->w; ox++)
                for (int o = 0; o < out; o++) {
                    double sum = b ? value(b, (size_t)o, by) : 0;
                    for (int i = 0; i < x->c * k * k; i++) {
                        int c = i / (k * k), iy = oy * stride - pad + i / k % k * dilation,
                            ix = ox * stride - pad + i % k * dilation;
                        if (iy < 0 || ix < 0 || iy >= x->h || ix >= x->w) continue;
                        sum += at(x, n, iy, ix)[c] * value(w, (size_t)(o * x->c * k * k + i), by);
                    }
                    at(y, n, oy, ox)[o] = sum;
                }
}

static void reference_conv(nn_params *params, const nudge *by, const char *name, map *x, int out, int k, int stride,
                           map *y)
{
    reference_dilated(params, by, name, x, out, k, stride, 1, y);
}

/* Adds what each pixel of x contributes to the pixels around its place in y. */
static void reference_transposed(nn_params *params, const nudge *by, const char *name, map *x, int out, int k,
                                 int stride, map *y)
{
    const float *w = find(params, name, "weight");
    *y = (map){.n = x->n, .h = x->h * stride, .w = x->w * stride, .c = out};
    const int pad = (k - stride) / 2;
    for (int i = 0; i < x->n * x->h * x->w * x->c * k * k; i++) {
        const int kx = i % k, ky = i / k % k, c = i / (k * k) % x->c, pixel = i / (k * k * x->c);
        const int ix = pixel % x->w, iy = pixel / x->w % x->h, n = pixel / (x->w * x->h);
        const int ox = ix * stride - pad + kx, oy = iy * stride - pad + ky;
        if (ox < 0 || oy < 0 || ox >= y->w || oy >= y->h) continue;
        for (int o = 0; o < out; o++)
            at(y, n, oy, ox)[o] += at(x, n, iy, ix)[c] * value(w, (size_t)(((c * out + o) * k + ky) * k + kx), by);
    }
}

static void reference_norm(nn_params *params, const nudge *by, const char *name, map *x, bool running, bool relu)
{
    const float *gamma = find(params, name, "weight"), *beta = find(params, name, "bias");
    int count = x->n * x->h * x->w;
    for (int c = 0; c < x->c; c++) {
        double mean = 0, variance = 0;
        for (int i = 0; i < count; i++)
            mean += x->v[i * x->c + c] / count;
        for (int i = 0; i < count; i++)
            variance += pow(x->v[i * x->c + c] - mean, 2) / count;
        if (running) {
            mean = (double)find(params, name, "running_mean")[c];
            variance = (double)find(params, name, "running_var")[c];
        }
        for (int i = 0; i < count; i++) {
            double *v = &x->v[i * x->c + c];
            *v = (*v - mean) / sqrt(variance + 1e-5) * value(gamma, (size_t)c, by) + value(beta, (size_t)c, by);
            if (relu && *v < 0) *v = 0;
        }
    }
}

/* Builds the net of these tests: every kind of convolution, twice with a gradient to its input. */
static nn_graph *build_net(void)
{
    nn_graph *g = nn_graph_new();
    nn_node *x = nn_compute(g, nn_input(g, "x", INPUT, 1));
    x = nn_relu(g, nn_batch_norm(g, nn_conv2d(g, x, "a", 5, 3, 1, NN_NO_BIAS), "an"));
    x = nn_relu(g, nn_conv2d(g, x, "b", 6, 4, 2, NN_BIAS));
    x = nn_batch_norm(g, nn_conv2d(g, x, "c", 4, 3, 1, NN_BIAS), "cn");
    x = nn_conv2d(g, x, "d", 7, 3, 2, NN_NO_BIAS);
    x = nn_batch_norm(g, nn_conv2d(g, nn_relu(g, x), "e", 3, 1, 1, NN_BIAS), "en");
    x = nn_add(g, nn_conv2d_transposed(g, x, "s", 4, 4, 2), nn_conv2d_transposed(g, x, "t", 4, 2, 2));
    x = nn_relu(g, nn_batch_norm(g, x, "tn"));
    x = nn_batch_norm(g, nn_conv2d_dilated(g, x, "u", 5, 3, 2, NN_NO_BIAS), "un");
    x = nn_float(g, nn_conv2d(g, x, "f", 2, 5, 1, NN_BIAS));
    nn_output(g, x, "y");
    nn_masked_l2(g, x, nn_input(g, "target", 2, 2), nn_input(g, "mask", 1, 2), "loss", 1);
    return g;
}

static void relu(map *m)
{
    for (int i = 0; i < m->n * m->h * m->w * m->c; i++)
        m->v[i] = m->v[i] > 0 ? m->v[i] : 0;
}

static void reference_net(nn_params *params, const float *input, const nudge *by, bool running, map *y)
{
    static map a, b, c;
    a = (map){.n = BATCH, .h = HEIGHT, .w = WIDTH, .c = INPUT};
    for (int i = 0; i < BATCH * HEIGHT * WIDTH * INPUT; i++)
        a.v[i] = (double)input[i];
    reference_conv(params, by, "a", &a, 5, 3, 1, &b);
    reference_norm(params, by, "an", &b, running, true);
    reference_conv(params, by, "b", &b, 6, 4, 2, &a);
    relu(&a);
    reference_conv(params, by, "c", &a, 4, 3, 1, &b);
    reference_norm(params, by, "cn", &b, running, false);
    reference_conv(params, by, "d", &b, 7, 3, 2, &a);
    relu(&a);
    reference_conv(params, by, "e", &a, 3, 1, 1, &b);
    reference_norm(params, by, "en", &b, running, false);
    reference_transposed(params, by, "s", &b, 4, 4, 2, &a);
    reference_transposed(params, by, "t", &b, 4, 2, 2, &c);
    for (int i = 0; i < a.n * a.h * a.w * a.c; i++)
        a.v[i] += c.v[i];
    reference_norm(params, by, "tn", &a, running, true);
    reference_dilated(params, by, "u", &a, 5, 3, 1, 2, &b);
    reference_norm(params, by, "un", &b, running, false);
    reference_conv(params, by, "f", &b, 2, 5, 1, y);
}

static void fill(float *x, size_t count, uint64_t stream, float low, float high)
{
    rng random = rng_at(17, 0, stream);
    for (size_t i = 0; i < count; i++)
        x[i] = rng_range(&random, low, high);
}

typedef struct fixture {
    nn_params *params;
    nn_program *program;
    float input[BATCH * HEIGHT * WIDTH * INPUT];
    size_t outputs;
} fixture;

static void open_fixture(fixture *f, nn_type type, nn_purpose purpose)
{
    nn_graph *g = build_net();
    assert_int_equal(nn_params_new(g, 9, &f->params), OK);
    for (size_t i = 0; i < nn_params_count(f->params); i++) { /* no value at which a mistake would be invisible */
        nn_param *p = nn_params_at(f->params, i);
        if (p->rank == 1) fill(p->value, p->count, i, strstr(p->name, "running_mean") ? -0.3f : 0.4f, 1.2f);
    }
    nn_params_touch(f->params);
    const nn_options options = {.batch = BATCH, .height = HEIGHT, .width = WIDTH, .type = type, .purpose = purpose};
    if (nn_compile(g, f->params, &options, &f->program) != OK) fail_msg("%s", status_message());
    nn_graph_free(g);
    f->outputs = BATCH * (HEIGHT / 2) * (WIDTH / 2) * 2;
    fill(f->input, sizeof f->input / sizeof(float), 1, -1, 1);
    memcpy(nn_input_data(f->program, "x"), f->input, sizeof f->input);
    fill(nn_input_data(f->program, "target"), f->outputs, 2, -1, 1);
    fill(nn_input_data(f->program, "mask"), f->outputs / 2, 3, 0, 1);
}

static void close_fixture(fixture *f)
{
    nn_program_free(f->program);
    nn_params_free(f->params);
}

/* Returns the root mean square error over the root mean square of the reference. */
static double relative_error(const fixture *f, const map *y)
{
    const float *out = nn_output_data(f->program, "y");
    double error = 0, square = 0;
    for (size_t i = 0; i < f->outputs; i++) {
        error += pow((double)out[i] - y->v[i], 2);
        square += y->v[i] * y->v[i];
    }
    return sqrt(error / square);
}

static void check_forward(nn_type type, nn_purpose purpose, double tolerance)
{
    static fixture f;
    static map y;
    open_fixture(&f, type, purpose);
    reference_net(f.params, f.input, &(nudge){0}, purpose == NN_INFER, &y);
    assert_int_equal(nn_forward(f.program), OK);
    double error = relative_error(&f, &y);
    if (!(error < tolerance)) fail_msg("relative error %g, tolerance %g", error, tolerance);
    close_fixture(&f);
}

/* float32: nine layers of sums of up to 80 products, each rounded to 2^-24: 1e-5 leaves an order of magnitude.
 * bfloat16: activations and weights of nine roundings to 2^-9 each, amplified by batch norms that subtract means: 3 %.
 */
static void training_forward_matches_the_definition(void **state)
{
    (void)state;
    check_forward(NN_FLOAT32, NN_TRAIN, 1e-5);
    check_forward(NN_BFLOAT16, NN_TRAIN, 0.03);
}

static void folded_batch_norm_matches_the_definition(void **state)
{
    (void)state;
    check_forward(NN_FLOAT32, NN_INFER, 1e-5);
    check_forward(NN_BFLOAT16, NN_INFER, 0.03);
}

static double reference_loss(const fixture *f, const nudge *by)
{
    static map y;
    reference_net(f->params, f->input, by, false, &y);
    const float *target = nn_input_data(f->program, "target"), *mask = nn_input_data(f->program, "mask");
    double loss = 0, sum = 0;
    for (size_t i = 0; i < f->outputs; i++) {
        loss += pow((y.v[i] - (double)target[i]) * (double)mask[i / 2], 2);
        sum += i % 2 ? (double)mask[i / 2] : 0;
    }
    return loss / sum;
}

/* Returns the error of one parameter's gradient against central differences, which are exact to 1e-8 in double. */
static double gradient_error(const fixture *f, const nn_param *p)
{
    const double step = 1e-5;
    double error = 0, square = 0;
    for (size_t i = 0; i < p->count; i += p->count / 12 + 1) {
        double up = reference_loss(f, &(nudge){p->value + i, step}),
               down = reference_loss(f, &(nudge){p->value + i, -step}), expected = (up - down) / (2 * step);
        error += pow((double)p->gradient[i] - expected, 2);
        square += expected * expected;
    }
    /* a bias before batch norm has no effect: its gradient is rounding alone */
    return sqrt(error) / (sqrt(square) + 0.01);
}

static void check_gradients(nn_type type, double tolerance)
{
    static fixture f;
    open_fixture(&f, type, NN_TRAIN);
    for (int run = 0; run < 2; run++) { /* gradients are zeroed first: a second run gives the same */
        assert_int_equal(nn_forward(f.program), OK);
        assert_int_equal(nn_backward(f.program), OK);
    }
    assert_float_equal(nn_loss(f.program, "loss"), reference_loss(&f, &(nudge){0}), tolerance);
    for (size_t i = 0; i < nn_params_count(f.params); i++) {
        const nn_param *p = nn_params_at(f.params, i);
        if (!p->gradient) continue;
        double error = gradient_error(&f, p);
        if (!(error < tolerance)) fail_msg("%s: relative error %g, tolerance %g", p->name, error, tolerance);
    }
    close_fixture(&f);
}

/* Tolerances are the forward pass's, with room for as many roundings again on the way back. */
static void gradients_match_central_differences(void **state)
{
    (void)state;
    check_gradients(NN_FLOAT32, 1e-4);
    check_gradients(NN_BFLOAT16, 0.1);
}

static void running_statistics_follow_the_batch(void **state)
{
    (void)state;
    static fixture f;
    static map x, y;
    open_fixture(&f, NN_FLOAT32, NN_TRAIN);
    nn_param *mean = nn_params_find(f.params, "an.running_mean"),
             *variance = nn_params_find(f.params, "an.running_var");
    float mean_before = mean->value[2], variance_before = variance->value[2];
    assert_int_equal(nn_forward(f.program), OK);
    x = (map){.n = BATCH, .h = HEIGHT, .w = WIDTH, .c = INPUT};
    for (size_t i = 0; i < sizeof f.input / sizeof(float); i++)
        x.v[i] = (double)f.input[i];
    reference_conv(f.params, &(nudge){0}, "a", &x, 5, 3, 1, &y);
    int count = BATCH * HEIGHT * WIDTH;
    double m = 0, v = 0;
    for (int i = 0; i < count; i++)
        m += y.v[i * 5 + 2] / count;
    for (int i = 0; i < count; i++)
        v += pow(y.v[i * 5 + 2] - m, 2) / (count - 1);
    assert_float_equal(mean->value[2], 0.9 * (double)mean_before + 0.1 * m, 1e-6);
    assert_float_equal(variance->value[2], 0.9 * (double)variance_before + 0.1 * v, 1e-6);
    close_fixture(&f);
}

static void running_statistics_can_be_the_mean_over_batches(void **state)
{
    (void)state;
    static fixture f;
    open_fixture(&f, NN_FLOAT32, NN_TRAIN);
    float *mean = nn_params_find(f.params, "an.running_mean")->value, *input = nn_input_data(f.program, "x");
    size_t count = sizeof f.input / sizeof(float);
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        nn_set_norm_momentum(f.program, 1);
        assert_int_equal(nn_forward(f.program), OK);
        sum += (double)mean[2];
        for (size_t k = 0; k < count; k++)
            input[k] += 0.25f * (float)(k % 3);
    }
    memcpy(input, f.input, sizeof f.input);
    for (int i = 0; i < 3; i++) {
        nn_set_norm_momentum(f.program, 1.0f / (float)(i + 1));
        assert_int_equal(nn_forward(f.program), OK);
        for (size_t k = 0; k < count; k++)
            input[k] += 0.25f * (float)(k % 3);
    }
    assert_float_equal(mean[2], sum / 3, 1e-6); /* rounding of three float sums */
    close_fixture(&f);
}

static void touched_parameters_are_picked_up(void **state)
{
    (void)state;
    static fixture f;
    static map y;
    open_fixture(&f, NN_FLOAT32, NN_INFER);
    assert_int_equal(nn_forward(f.program), OK);
    nn_params_find(f.params, "b.weight")->value[5] += 0.5f;
    nn_params_find(f.params, "an.running_mean")->value[1] += 0.5f;
    nn_params_touch(f.params);
    assert_int_equal(nn_forward(f.program), OK);
    reference_net(f.params, f.input, &(nudge){0}, true, &y);
    assert_true(relative_error(&f, &y) < 1e-5);
    close_fixture(&f);
}

static nn_program *strided_program(nn_type type, nn_params **params)
{
    enum { CHANNELS = 8, SIZE = 64 };
    nn_graph *g = nn_graph_new();
    nn_node *x = nn_compute(g, nn_input(g, "x", CHANNELS, 1));
    nn_node *y = nn_float(g, nn_conv2d(g, x, "y", CHANNELS, 1, 2, NN_NO_BIAS));
    nn_masked_l2(g, y, nn_input(g, "t", CHANNELS, 2), nn_input(g, "m", 1, 2), "loss", 1);
    nn_program *p;
    assert_int_equal(nn_params_new(g, 1, params), OK);
    const nn_options options = {.batch = 1, .height = SIZE, .width = SIZE, .type = type, .purpose = NN_TRAIN};
    if (nn_compile(g, *params, &options, &p) != OK) fail_msg("%s", status_message());
    nn_graph_free(g);
    rng r = rng_at(4, 0, 0);
    for (int i = 0; i < SIZE * SIZE * CHANNELS; i++)
        nn_input_data(p, "x")[i] = rng_range(&r, -1, 1);
    for (int i = 0; i < SIZE * SIZE / 4; i++)
        nn_input_data(p, "m")[i] = 1;
    return p;
}

/* A gate's first convolution has fewer channels than a vector, so that threads could write to the same vector. */
static void gradients_of_a_narrow_strided_convolution_are_the_same_every_time(void **state)
{
    (void)state;
    int before = parallel_threads();
    threads_use_here(4);
    for (nn_type type = NN_FLOAT32; type <= NN_BFLOAT16; type++) {
        nn_params *params;
        nn_program *p = strided_program(type, &params);
        const nn_param *w = nn_params_at(params, 0);
        float first[64];
        for (int i = 0; i < 100; i++) {
            assert_int_equal(nn_forward(p), OK);
            assert_int_equal(nn_backward(p), OK);
            if (i == 0) memcpy(first, w->gradient, sizeof first);
            assert_memory_equal(first, w->gradient, sizeof first);
        }
        nn_program_free(p);
        nn_params_free(params);
    }
    threads_use_here(before);
}

enum { SMALL_SIDE = 6, SMALL_CHANNELS = 128, SMALL_VALUES = SMALL_SIDE * SMALL_SIDE * SMALL_CHANNELS };

/* Runs a chain of 1×1 convolutions on a picture of 6×6, of which the third's result lies before the second's in memory,
 * which is read after it. */
static void run_small(nn_type type, float *out)
{
    nn_graph *g = nn_graph_new();
    nn_node *x = nn_compute(g, nn_input(g, "x", SMALL_CHANNELS, 1));
    nn_node *second = nn_conv2d(g, nn_conv2d(g, x, "a", SMALL_CHANNELS, 1, 1, 0), "b", SMALL_CHANNELS, 1, 1, 0);
    nn_node *third = nn_add(g, nn_conv2d(g, second, "c", SMALL_CHANNELS, 1, 1, 0), x);
    nn_output(g, nn_float(g, nn_conv2d(g, second, "d", SMALL_CHANNELS, 1, 1, 0)), "second");
    nn_output(g, nn_float(g, nn_conv2d(g, third, "e", SMALL_CHANNELS, 1, 1, 0)), "third");
    nn_params *params;
    nn_program *p;
    assert_int_equal(nn_params_new(g, 1, &params), OK);
    const nn_options options = {.batch = 1, .height = SMALL_SIDE, .width = SMALL_SIDE, .type = type};
    if (nn_compile(g, params, &options, &p) != OK) fail_msg("%s", status_message());
    nn_graph_free(g);
    rng r = rng_at(5, 0, 0);
    for (int i = 0; i < SMALL_VALUES; i++)
        nn_input_data(p, "x")[i] = rng_range(&r, -1, 1);
    assert_int_equal(nn_forward(p), OK);
    memcpy(out, nn_output_data(p, "second"), SMALL_VALUES * sizeof *out);
    memcpy(out + SMALL_VALUES, nn_output_data(p, "third"), SMALL_VALUES * sizeof *out);
    nn_program_free(p);
    nn_params_free(params);
}

/* OneDNN's 1×1 convolution with a sum writes, by AMX, whole tiles of 16 pixels, past the last of 36. */
static void convolutions_of_small_pictures_write_no_further(void **state)
{
    (void)state;
    static float exact[2 * SMALL_VALUES], found[2 * SMALL_VALUES];
    double off = 0, all = 0;
    run_small(NN_FLOAT32, exact);
    run_small(NN_BFLOAT16, found);
    for (int i = 0; i < 2 * SMALL_VALUES; i++) {
        off += fabs((double)(found[i] - exact[i]));
        all += fabs((double)exact[i]);
    }
    assert_true(off < 0.02 * all);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(training_forward_matches_the_definition),
        cmocka_unit_test(folded_batch_norm_matches_the_definition),
        cmocka_unit_test(gradients_match_central_differences),
        cmocka_unit_test(running_statistics_follow_the_batch),
        cmocka_unit_test(running_statistics_can_be_the_mean_over_batches),
        cmocka_unit_test(touched_parameters_are_picked_up),
        cmocka_unit_test(gradients_of_a_narrow_strided_convolution_are_the_same_every_time),
        cmocka_unit_test(convolutions_of_small_pictures_write_no_further),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
