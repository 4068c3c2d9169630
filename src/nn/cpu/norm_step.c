/* SPDX-License-Identifier: MIT */
/* Batch norm as a step: batch statistics in training, running ones otherwise. */
#include <math.h>
#include <stdlib.h>

#include "nn/cpu/kernels/norm.h"
#include "nn/cpu/kernels/steps.h"

typedef struct norm {
    float *mean, *variance, *inverse_deviation, *scale, *shift; /* per channel, in one block */
    float *partial;
    double *sums; /* two a channel */
} norm;

static void prepare(const nn_step *step, const float *mean, const float *variance)
{
    const norm *state = step->state;
    for (int i = 0; i < step->out.c; i++) {
        state->inverse_deviation[i] = 1 / sqrtf(variance[i] + NORM_EPSILON);
        state->scale[i] = step->params.weight->value[i] * state->inverse_deviation[i];
        state->shift[i] = step->params.bias->value[i] - mean[i] * state->scale[i];
    }
}

/* Updates running statistics as PyTorch does, with the unbiased variance. */
static void update_running(const nn_step *step)
{
    const norm *state = step->state;
    double count = (double)step->out.n * step->out.h * step->out.w * ranks_count(step->together);
    float unbiased = count > 1 ? (float)(count / (count - 1)) : 1;
    float *mean = step->params.running_mean->value, *variance = step->params.running_var->value;
    for (int i = 0; i < step->out.c; i++) {
        mean[i] += step->momentum * (state->mean[i] - mean[i]);
        variance[i] += step->momentum * (unbiased * state->variance[i] - variance[i]);
    }
}

static status norm_forward(nn_step *step)
{
    norm *state = step->state;
    if (step->train) {
        status s =
            norm_statistics(&step->in[0], step->together, state->partial, state->sums, state->mean, state->variance);
        if (s != OK) return s;
        prepare(step, state->mean, state->variance);
        update_running(step);
    } else {
        prepare(step, step->params.running_mean->value, step->params.running_var->value);
    }
    norm_apply(&step->in[0], state->scale, state->shift, step->relu, &step->out);
    return OK;
}

static status norm_backward_step(nn_step *step)
{
    norm *state = step->state;
    const norm_channels channels = {state->mean,
                                    state->inverse_deviation,
                                    step->params.weight->value,
                                    step->params.bias->value,
                                    step->params.weight->gradient,
                                    step->params.bias->gradient};
    return norm_backward(&step->in[0], &step->out_gradient, step->relu, &channels, step->together, state->partial,
                         state->sums, step->wants[0] ? &step->in_gradient[0] : NULL, step->accumulate[0]);
}

static void norm_release(nn_step *step)
{
    norm *state = step->state;
    free(state->mean);
    free(state->sums);
    free(state);
}

status norm_create(nn_step *step)
{
    static const step_functions functions = {
        .forward = norm_forward, .backward = norm_backward_step, .release = norm_release};
    norm *state = calloc(1, sizeof *state);
    if (!state) return fail(MERLIN_NO_MEMORY, "no memory for batch norm");
    step->run = &functions;
    step->state = state;
    step->reads_in = true;
    size_t c = (size_t)step->out.c, count = 5 * c + norm_partial_floats(step->out.c);
    state->mean = calloc(count, sizeof(float));
    state->sums = calloc(2 * c, sizeof(double));
    if (!state->mean || !state->sums) return fail(MERLIN_NO_MEMORY, "no memory for batch norm");
    step->own_bytes = count * sizeof(float) + 2 * c * sizeof(double);
    state->variance = state->mean + c;
    state->inverse_deviation = state->variance + c;
    state->scale = state->inverse_deviation + c;
    state->shift = state->scale + c;
    state->partial = state->shift + c;
    return OK;
}
