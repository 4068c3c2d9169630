/* SPDX-License-Identifier: MIT */
/* Parts of which both rivals are made. Every convolution but a head's is followed by batch norm and ReLU. */
#ifndef MERLIN_MODEL_RIVALS_RIVAL_PARTS_H
#define MERLIN_MODEL_RIVALS_RIVAL_PARTS_H

#include "nn/nn.h"

/* Adds a convolution of stride 2. */
nn_node *rival_down(nn_graph *g, nn_node *x, const char *name, int out, int kernel);
/* Adds a transposed 4×4 convolution of stride 2. */
nn_node *rival_up(nn_graph *g, nn_node *x, const char *name, int out);
/* Adds a 3×3 convolution. */
nn_node *rival_same(nn_graph *g, nn_node *x, const char *name, int out, int dilation);
/* Adds blocks of two 3×3 convolutions in parallel to x, `name.block0`, … */
nn_node *rival_residual(nn_graph *g, nn_node *x, const char *name, int count, int width, int dilation);
/* Adds a 5×5 convolution and tanh, float. */
nn_node *rival_head(nn_graph *g, nn_node *x, const char *name, int channels);

/* A full-size decoder: six transposed convolutions, after each but the last the features of its scale are added as
 * channels. */
typedef struct rival_decoder_inputs {
    const char *name;
    nn_node *bottleneck;
    nn_node *const *skips;  /* the encoder's features, six scales from 1/2 on, of which the last is the bottleneck */
    nn_node *const *shared; /* another decoder's, five scales from 1/2 on; NULL: none */
} rival_decoder_inputs;

/* Adds it; own (may be NULL) receives its features at five scales from 1/2 on. Returns the full-size ones. */
nn_node *rival_decoder(nn_graph *g, const rival_decoder_inputs *in, nn_node **own);

/* Adds an encoder of six scales from 1/2 on, of an image of any channels. */
void rival_encoder(nn_graph *g, nn_node *x, const char *name, nn_node **features);

/* Writes "a.b" into a buffer of RIVAL_NAME characters. */
enum { RIVAL_NAME = 96 };
const char *rival_join(char *buffer, const char *a, const char *b);

#endif
