/* SPDX-License-Identifier: MIT */
/* The sizes of a convolution by winograd.h, and what is done behind it. */
#ifndef MERLIN_NN_CPU_WINOGRAD_WINOGRAD_SHAPE_H
#define MERLIN_NN_CPU_WINOGRAD_WINOGRAD_SHAPE_H

#include <stdbool.h>
#include <stddef.h>

#include "nn/nn.h"

enum { WINOGRAD_CHANNELS = 16 };

typedef struct winograd {
    int n, h, w;      /* of input and output */
    int in, out;      /* channels */
    int threads;      /* that may work on it; room is for so many */
    nn_type from, to; /* of input and output in memory */
} winograd;

/* Work on the sums before they are stored. */
typedef struct winograd_after {
    const float *bias;  /* out, or NULL */
    const void *beside; /* of the output's shape and the input's type: added; or NULL */
    bool relu;
    bool accumulate; /* add to what is there */
} winograd_after;

/* The convolution that takes g's output's gradient to its input's. */
static inline winograd winograd_back(const winograd *g)
{
    return (winograd){g->n, g->h, g->w, g->out, g->in, g->threads, g->to, g->from};
}

size_t winograd_tiles(const winograd *g);

#endif
