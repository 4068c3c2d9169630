/* SPDX-License-Identifier: MIT */
/* Parts of which both rivals are made. Every convolution but a head's is followed by batch norm and ReLU. */
#ifndef MERLIN_MODEL_RIVALS_RIVAL_PARTS_H
#define MERLIN_MODEL_RIVALS_RIVAL_PARTS_H

#include "model/model_network.h"

enum { RIVAL_SCALES = 6, RIVAL_WIDTH = 64, RIVAL_REFINED = 128 };

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

/* Adds a cascade's encoder, which ends at 1/4 of the size with RIVAL_REFINED channels; half receives its features at
 * 1/2. */
nn_node *rival_refining_encoder(nn_graph *g, nn_node *seen, const char *name, nn_node **half);

/* A cascade's decoder from there on. */
typedef struct rival_refining {
    const char *name;
    nn_node *from;
    nn_node *beside[2]; /* features at 1/2 that are added as channels; NULL: none */
    int channels;       /* of the head */
} rival_refining;

/* Adds it up to its head; half (may be NULL) receives its own features at 1/2. */
nn_node *rival_refine(nn_graph *g, const rival_refining *in, nn_node **half);

/* Takes the maps from three channels each of albedo, normal, roughness and depth, the latter two being means. */
void rival_take_maps(model_nodes *n, nn_node *const y[4]);

/* Writes "a.b" into a buffer of RIVAL_NAME characters. */
enum { RIVAL_NAME = 96 };
const char *rival_join(char *buffer, const char *a, const char *b);

#endif
