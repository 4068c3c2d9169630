/* SPDX-License-Identifier: MIT */
/* Adam (Kingma & Ba 2015, algorithm 1) with clipping by the gradients' global norm (Pascanu et al. 2013) and decoupled
 * weight decay (Loshchilov & Hutter 2019, algorithm 2). */
#include "nn/adam_step.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "nn/device.h"

struct nn_adam {
    const nn_device *device;
    nn_params *params;
    nn_adam_options options;
    int64_t steps, skipped;
    float *moments; /* first moments of all values, then second moments */
};

status nn_adam_new(nn_params *params, const nn_adam_options *options, nn_adam **out)
{
    if (!(options->beta1 >= 0 && options->beta1 < 1 && options->beta2 >= 0 && options->beta2 < 1))
        return fail(MERLIN_WRONG_USE, "Adam's betas must be at least 0 and below 1");
    if (!(options->epsilon > 0 && options->clip_norm >= 0))
        return fail(MERLIN_WRONG_USE, "Adam's epsilon must be positive and its clipping norm at least 0");
    if (!(options->weight_decay >= 0 && options->weight_decay <= 1))
        return fail(MERLIN_WRONG_USE, "Adam's weight decay must be from 0 to 1");
    nn_adam *adam = calloc(1, sizeof *adam);
    float *moments = calloc(2 * nn_params_values(params) + 1, sizeof *moments);
    if (!adam || !moments) {
        free(adam);
        free(moments);
        return fail(MERLIN_NO_MEMORY, "no memory for the optimizer's moments of %zu values", nn_params_values(params));
    }
    *adam = (nn_adam){.device = cpu_device(), .params = params, .options = *options, .moments = moments};
    *out = adam;
    return OK;
}

void nn_adam_free(nn_adam *adam)
{
    if (!adam) return;
    free(adam->moments);
    free(adam);
}

static double gradient_norm(const nn_adam *adam)
{
    nn_params *params = adam->params;
    double sum = 0;
    for (size_t i = 0; i < nn_params_count(params); i++) {
        const nn_param *p = nn_params_at(params, i);
        if (p->gradient) sum += adam->device->sum_squares(p->gradient, p->count);
    }
    return sqrt(sum);
}

/* Largest gradient norm that is applied; the square of a larger one overflows, so that the second moment would stay
 * infinite and its parameter would never change again. */
static const double LARGEST_NORM = 1e19;

status nn_adam_step(nn_adam *adam, float learning_rate)
{
    if (!(learning_rate >= 0) || isinf(learning_rate))
        return fail(MERLIN_WRONG_USE, "the learning rate must be a number of at least 0");
    double norm = gradient_norm(adam), clip = (double)adam->options.clip_norm;
    double scale = clip > 0 && norm > clip ? clip / norm : 1;
    if (!(norm * scale <= LARGEST_NORM)) {
        adam->skipped++;
        return OK;
    }
    adam->steps++;
    adam_step step = {.beta1 = adam->options.beta1,
                      .beta2 = adam->options.beta2,
                      .epsilon = adam->options.epsilon,
                      .correction1 = (float)(1 - pow((double)adam->options.beta1, (double)adam->steps)),
                      .correction2 = (float)(1 - pow((double)adam->options.beta2, (double)adam->steps)),
                      .gradient_scale = (float)scale};
    for (size_t i = 0; i < nn_params_count(adam->params); i++) {
        nn_param *p = nn_params_at(adam->params, i);
        if (!p->gradient) continue;
        step.learning_rate = learning_rate * p->learning_rate_scale;
        step.kept = p->decays ? 1 - step.learning_rate * adam->options.weight_decay : 1;
        adam->device->adam(&step, p->count, p->value, p->gradient, nn_adam_moment(adam, i, 1),
                           nn_adam_moment(adam, i, 2));
    }
    nn_params_touch(adam->params);
    return OK;
}

int64_t nn_adam_steps(const nn_adam *adam)
{
    return adam->steps;
}

int64_t nn_adam_skipped(const nn_adam *adam)
{
    return adam->skipped;
}

void nn_adam_set_steps(nn_adam *adam, int64_t steps, int64_t skipped)
{
    adam->steps = steps;
    adam->skipped = skipped;
}

float *nn_adam_moment(nn_adam *adam, size_t param, int which)
{
    size_t place = nn_params_at(adam->params, param)->place;
    return adam->moments + place + (which == 1 ? 0 : nn_params_values(adam->params));
}
