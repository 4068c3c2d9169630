/* SPDX-License-Identifier: MIT */
/* Sizes of a convolution by winograd.h, and the operations fused after it. */
#ifndef MERLIN_NN_CPU_WINOGRAD_WINOGRAD_SHAPE_H
#define MERLIN_NN_CPU_WINOGRAD_WINOGRAD_SHAPE_H

#include <stdbool.h>
#include <stddef.h>

#include "nn/nn.h"

enum { WINOGRAD_CHANNELS = 16 };

typedef struct winograd {
    int n, h, w;      /* size of input and output */
    int in, out;      /* channels */
    int threads;      /* most threads that work on it; buffers are for so many */
    nn_type from, to; /* types of input and output in memory */
} winograd;

/* Operations on the sums before they are stored. */
typedef struct winograd_after {
    const float *bias;  /* out, or NULL */
    const void *beside; /* added, of the output's shape and the input's type; or NULL */
    bool relu;
    bool accumulate; /* add to the output's values */
} winograd_after;

/* Returns the convolution that takes the gradient of g's output to that of its input. */
static inline winograd winograd_back(const winograd *g)
{
    return (winograd){g->n, g->h, g->w, g->out, g->in, g->threads, g->to, g->from};
}

size_t winograd_tiles(const winograd *g);

#endif
