/* SPDX-License-Identifier: MIT */
#include "lab/train/average.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"

/* steps between updates: reading the memory of all weights at every step would cost some per cent of training */
enum { STRIDE = 8 };

struct train_average {
    nn_params *params;
    double decay;
    float *values; /* mean of each parameter's values */
};

status train_average_new(nn_params *params, double decay, train_average **out)
{
    size_t total = nn_params_values(params);
    train_average *a = calloc(1, sizeof *a);
    float *values = calloc(total + 1, sizeof *values);
    if (!a || !values) {
        free(a);
        free(values);
        return fail(MERLIN_NO_MEMORY, "no memory for the mean of %zu weights", total);
    }
    *a = (train_average){.params = params, .decay = decay, .values = values};
    for (size_t i = 0; i < nn_params_count(params); i++) {
        const nn_param *p = nn_params_at(params, i);
        memcpy(values + p->place, p->value, p->count * sizeof *values);
    }
    *out = a;
    return OK;
}

void train_average_free(train_average *a)
{
    if (!a) return;
    free(a->values);
    free(a);
}

typedef struct blend {
    train_average *average;
    float rate; /* weight of the new values */
} blend;

static void blend_param(void *context, size_t i)
{
    const blend *b = context;
    const nn_param *p = nn_params_at(b->average->params, i);
    float *mean = b->average->values + p->place;
    for (size_t k = 0; k < p->count; k++)
        mean[k] += b->rate * (p->value[k] - mean[k]);
}

void train_average_add(train_average *a, int64_t step, bool last)
{
    int64_t passed = step % STRIDE ? step % STRIDE : STRIDE;
    if (passed < STRIDE && !last) return;
    double young = (double)(1 + step) / (double)(10 + step), decay = young < a->decay ? young : a->decay;
    blend b = {a, (float)(1 - pow(decay, (double)passed))};
    parallel_for(nn_params_count(a->params), blend_param, &b);
}

void train_average_swap(train_average *a)
{
    for (size_t i = 0; i < nn_params_count(a->params); i++) {
        const nn_param *p = nn_params_at(a->params, i);
        float *mean = a->values + p->place;
        for (size_t k = 0; k < p->count; k++) {
            float value = p->value[k];
            p->value[k] = mean[k];
            mean[k] = value;
        }
    }
    nn_params_touch(a->params);
}

float *train_average_values(train_average *a, size_t i)
{
    return a->values + nn_params_at(a->params, i)->place;
}
