/* SPDX-License-Identifier: MIT */
/* A batch shared by several processes has the losses, gradients and statistics of one process with the whole batch. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/rng.h"
#include "nn/nn.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

#include "forked_ranks.h"

enum { BATCH = 4, SIZE = 32, MOST = 4096, LOSSES = 3, STEPS = 2 };

static const char *const losses[LOSSES] = {"square", "gradient", "similarity"};

/* The results of a process's steps. */
typedef struct left {
    float gradient[MOST], value[MOST], loss[LOSSES + 1];
    size_t gradients, values;
} left;

typedef struct runs {
    nn_type type;
    left *of; /* one for each rank */
} runs;

static nn_graph *build(void)
{
    nn_graph *g = nn_graph_new();
    nn_node *image = nn_input(g, "image", 3, 1), *mask = nn_input(g, "mask", 1, 1);
    nn_node *x = nn_conv2d(g, nn_compute(g, image), "one", 16, 3, 2, NN_NO_BIAS);
    x = nn_relu(g, nn_batch_norm(g, x, "one.bn"));
    x = nn_tanh(g, nn_batch_norm(g, nn_conv2d(g, nn_upsample_bilinear(g, x), "two", 3, 3, 1, NN_NO_BIAS), "two.bn"));
    x = nn_float(g, x);
    nn_masked_l2(g, x, image, mask, losses[0], 1);
    nn_masked_gradient_l2(g, x, image, mask, losses[1], 0.5f);
    nn_masked_dssim(g, x, image, mask, losses[2], 0.5f);
    return g;
}

/* Fills in pictures of the batch, beginning at `first`; their masks are of very different sizes. */
static void fill(nn_program *p, int first, int count)
{
    float *image = nn_input_data(p, "image"), *mask = nn_input_data(p, "mask");
    for (int n = 0; n < count; n++) {
        rng r = rng_at(5, (uint64_t)(first + n), 1);
        for (int i = 0; i < SIZE * SIZE * 3; i++)
            image[n * SIZE * SIZE * 3 + i] = rng_range(&r, 0, (float)(first + n + 1));
        for (int i = 0; i < SIZE * SIZE; i++)
            mask[n * SIZE * SIZE + i] = i < SIZE * SIZE * (first + n + 1) / (BATCH + 1);
    }
}

static status run_steps(const ranks *r, nn_program *p, nn_params *params)
{
    nn_adam *adam;
    status s = nn_adam_new(params, &(nn_adam_options){0.9f, 0.99f, 1e-3f, 1, 0.1f}, &adam);
    int count = BATCH / ranks_count(r);
    for (int i = 0; s == OK && i < STEPS; i++) {
        fill(p, ranks_index(r) * count, count);
        s = nn_forward(p);
        if (s == OK) s = nn_backward(p);
        if (s == OK) s = nn_adam_step(adam, 0.01f);
    }
    nn_adam_free(adam);
    return s;
}

static void keep(const nn_program *p, nn_params *params, left *out)
{
    for (size_t i = 0; i < nn_params_count(params); i++) {
        const nn_param *q = nn_params_at(params, i);
        if (out->values + q->count > MOST) abort();
        memcpy(out->value + out->values, q->value, q->count * sizeof(float));
        out->values += q->count;
        if (!q->gradient) continue;
        memcpy(out->gradient + out->gradients, q->gradient, q->count * sizeof(float));
        out->gradients += q->count;
    }
    for (int i = 0; i < LOSSES; i++)
        out->loss[i] = nn_loss(p, losses[i]);
    out->loss[LOSSES] = nn_total_loss(p);
}

static void train(ranks *r, void *context)
{
    const runs *all = context;
    nn_graph *g = build();
    nn_params *params;
    nn_program *p;
    nn_options o = {.batch = BATCH / r->count,
                    .height = SIZE,
                    .width = SIZE,
                    .type = all->type,
                    .purpose = NN_TRAIN,
                    .together = r};
    if (nn_params_new(g, 7, &params) != OK || nn_compile(g, params, &o, &p) != OK || run_steps(r, p, params) != OK)
        abort();
    keep(p, params, &all->of[r->index]);
    nn_program_free(p);
    nn_params_free(params);
    nn_graph_free(g);
}

static float largest(const float *x, size_t count)
{
    float most = 0;
    for (size_t i = 0; i < count; i++)
        most = x[i] > most ? x[i] : -x[i] > most ? -x[i] : most;
    return most;
}

static void assert_close(const float *a, const float *b, size_t count, float share)
{
    float bound = share * largest(b, count);
    for (size_t i = 0; i < count; i++)
        if (!(a[i] - b[i] <= bound && b[i] - a[i] <= bound))
            fail_msg("value %zu: %g for %g, more than %g apart", i, (double)a[i], (double)b[i], (double)bound);
}

/* The difference is rounding alone: of floats a millionth, in sums of thousands and two steps some more; of bfloat16 a
 * 256th. */
static void compare(int count, nn_type type, float share)
{
    runs one = {type, forked_memory(sizeof *one.of)}, many = {type, forked_memory((size_t)count * sizeof *many.of)};
    assert_int_equal(forked_run(1, train, &one), 1);
    assert_int_equal(forked_run(count, train, &many), count);
    for (int i = 0; i < count; i++) {
        assert_memory_equal(&many.of[i], &many.of[0], sizeof *many.of);
        assert_close(many.of[i].loss, one.of->loss, LOSSES + 1, share);
        assert_close(many.of[i].gradient, one.of->gradient, one.of->gradients, share);
        assert_close(many.of[i].value, one.of->value, one.of->values, share);
    }
    assert_true(largest(one.of->gradient, one.of->gradients) > 0);
}

static void ranks_have_the_gradients_of_one_process(void **state)
{
    (void)state;
    compare(2, NN_FLOAT32, 3e-5f);
    compare(4, NN_FLOAT32, 3e-5f);
}

static void ranks_in_bfloat16_have_them_too(void **state)
{
    (void)state;
    compare(2, NN_BFLOAT16, 0.03f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(ranks_have_the_gradients_of_one_process),
                                       cmocka_unit_test(ranks_in_bfloat16_have_them_too)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
