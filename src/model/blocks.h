/* SPDX-License-Identifier: MIT */
/* Building blocks of MERLiN's encoders and decoders. Channels last; level 0 is half the image's size, each further
 * level half of the one before. */
#ifndef MERLIN_MODEL_BLOCKS_H
#define MERLIN_MODEL_BLOCKS_H

#include "model/model_config.h"
#include "nn/nn.h"

/* Adds a 3×3 convolution, batch norm and ReLU: parameters `name.conv.*` and `name.norm.*`. */
nn_node *block_conv(nn_graph *g, nn_node *x, const char *name, int out, int stride);

/* Adds a residual block: two 3×3 convolutions in parallel to x, whose width is `width`, parameters `name.a.*` and
 * `name.b.*`; it is the identity until it is trained (nn_batch_norm_zero). He et al. 2016, without the last ReLU. */
nn_node *block_residual(nn_graph *g, nn_node *x, const char *name, int width);

typedef struct block_encoder_shape {
    const int *widths, *blocks; /* MODEL_LEVELS of each; blocks NULL: none */
    nn_node *beside;            /* full-size side input of the first layer (`name.beside.*`); NULL: none */
    nn_node *share;             /* another one, each pixel's share of the pictures' light (`name.share.*`) */
    bool several;               /* pictures of an object exchange what they see at every level (block_exchange) */
} block_encoder_shape;

/* Adds an encoder from the packed full-size input (float, any channels) to features at every level. */
void block_encoder(nn_graph *g, nn_node *x, const char *name, const block_encoder_shape *shape,
                   nn_node *features[MODEL_LEVELS]);

/* Adds to each picture's features what the object's pictures have in common: its own, their maximum and their mean
 * through a 1×1 convolution (`name.exchange.*`), and, if `attention`, attention among the pictures at each pixel
 * (`name.attention.*`). Both add nothing until they are trained. */
nn_node *block_exchange(nn_graph *g, nn_node *x, const char *name, int width, bool attention);
/* Adds an object's features from those of its pictures: their mean and, once trained, of maximum, mean and spread
 * (`name.*`). For one picture it is that picture's. */
nn_node *block_fuse(nn_graph *g, nn_node *x, const char *name, int width);

/* Inputs of a decoder that compares an object's pictures at each pixel. */
typedef struct block_pixel_inputs {
    nn_node *pixels; /* the pictures' own values, 2×2 pixels packed into channels */
    nn_node *own;    /* each picture's features, at half size */
    nn_node *object; /* the object's, likewise */
    nn_node *light;  /* each picture's light: vectors */
} block_pixel_inputs;

/* Adds a decoder for 2×2 pixels at a time: attention among the pictures, pooled by a learned query (Ikehata, SDM-UniPS,
 * CVPR 2023, and its kind). Full size, `channels` of the object, float; zero until it is trained. */
nn_node *block_pixels(nn_graph *g, const block_pixel_inputs *in, const char *name, int channels);

typedef struct block_decoder_inputs {
    const char *name;
    const int *widths;
    const int *blocks; /* residual blocks after levels 0 to 3; NULL: none */
    bool gated;
    nn_node *bottleneck;    /* at level 4 */
    nn_node *const *skips;  /* the encoder's features, levels 0 to 4 */
    nn_node *const *shared; /* another decoder's features, levels 0 to 3; NULL: none */
} block_decoder_inputs;

/* Adds a decoder from the bottleneck up to level 0; features receives levels 0 to 3. */
void block_decoder(nn_graph *g, const block_decoder_inputs *in, nn_node *features[MODEL_LEVELS - 1]);

/* Adds the step from level 0 to full size: a 3×3 convolution whose outputs are the four pixels of each 2×2 block.
 * Float. */
nn_node *block_head(nn_graph *g, nn_node *x, const char *name, int channels);

#endif
