/* SPDX-License-Identifier: MIT */
#include "model/blocks.h"

#include <stdio.h>

enum { NAME = 96 };
/* Number of heads of attention among pictures, and of channels a head in the encoder. */
enum { HEADS = 4, HEAD_WIDTH = 32 };
/* Numbers of channels, blocks and channels of the light in the decoder by pixel. */
enum { PIXEL_WIDTH = 64, PIXEL_BLOCKS = 2, PIXEL_LIGHT = 32 };

/* Writes "a.b" to the caller's buffer; the graph copies names. */
static const char *join(char *buffer, const char *a, const char *b)
{
    snprintf(buffer, NAME, "%.63s.%.31s", a, b);
    return buffer;
}

nn_node *block_conv(nn_graph *g, nn_node *x, const char *name, int out, int stride)
{
    char buffer[NAME];
    nn_node *y = nn_conv2d(g, x, join(buffer, name, "conv"), out, 3, stride, NN_NO_BIAS);
    return nn_relu(g, nn_batch_norm(g, y, join(buffer, name, "norm")));
}

nn_node *block_residual(nn_graph *g, nn_node *x, const char *name, int width)
{
    char buffer[NAME];
    nn_node *y = block_conv(g, x, join(buffer, name, "a"), width, 1);
    y = nn_conv2d(g, y, join(buffer, name, "b.conv"), width, 3, 1, NN_NO_BIAS);
    return nn_add(g, x, nn_batch_norm_zero(g, y, join(buffer, name, "b.norm")));
}

/* Adds residual blocks `name.block0`, `name.block1`, ...: *blocks of them; blocks NULL: none. */
static nn_node *residual_blocks(nn_graph *g, nn_node *x, const char *name, const int *blocks, int width)
{
    for (int i = 0; blocks && i < *blocks; i++) {
        char block[NAME];
        snprintf(block, sizeof block, "%.63s.block%d", name, i);
        x = block_residual(g, x, block, width);
    }
    return x;
}

/* Adds a full-size side input of the first layer to y, through a convolution that is zero until it is trained. */
static nn_node *join_beside(nn_graph *g, nn_node *y, nn_node *beside, const char *name, int kernel, int width)
{
    nn_node *packed = nn_space_to_depth(g, nn_compute(g, beside), 2);
    return nn_add(g, y, nn_conv2d_zero(g, packed, name, width, kernel, 1, NN_NO_BIAS));
}

/* Adds block_conv of the packed picture, with its side inputs. */
static nn_node *first_layer(nn_graph *g, nn_node *x, const char *level, const char *name,
                            const block_encoder_shape *shape)
{
    char buffer[NAME], own[NAME];
    join(own, level, "a");
    if (!shape->beside) return block_conv(g, x, own, shape->widths[0], 1);
    nn_node *y = nn_conv2d(g, x, join(buffer, own, "conv"), shape->widths[0], 3, 1, NN_NO_BIAS);
    y = join_beside(g, y, shape->beside, join(buffer, name, "beside"), 1, shape->widths[0]);
    if (shape->share) y = join_beside(g, y, shape->share, join(buffer, name, "share"), 3, shape->widths[0]);
    return nn_relu(g, nn_batch_norm(g, y, join(buffer, own, "norm")));
}

void block_encoder(nn_graph *g, nn_node *x, const char *name, const block_encoder_shape *shape,
                   nn_node *features[MODEL_LEVELS])
{
    /* packing 2×2 pixels into channels gives the first layer enough channels for the vector units */
    nn_node *y = nn_space_to_depth(g, nn_compute(g, x), 2);
    for (int i = 0; i < MODEL_LEVELS; i++) {
        char level[NAME], buffer[NAME];
        snprintf(level, sizeof level, "%.48s.level%d", name, i);
        y = i ? block_conv(g, y, join(buffer, level, "a"), shape->widths[i], 2) : first_layer(g, y, level, name, shape);
        if (i) y = block_conv(g, y, join(buffer, level, "b"), shape->widths[i], 1);
        if (i == MODEL_LEVELS - 1) y = block_conv(g, y, join(buffer, level, "c"), shape->widths[i], 1);
        y = residual_blocks(g, y, level, shape->blocks ? &shape->blocks[i] : NULL, shape->widths[i]);
        /* at the two coarsest levels attention costs little, and sees most of the object */
        if (shape->several) y = block_exchange(g, y, level, shape->widths[i], i >= MODEL_LEVELS - 2);
        features[i] = y;
    }
}

/* Adds multi-head attention among the pictures of normalized features (Vaswani et al. 2017, with the norm before it).
 */
static nn_node *attend(nn_graph *g, nn_node *x, const char *name, int width, int head_width)
{
    char buffer[NAME], own[NAME];
    join(own, name, "attention");
    nn_node *y = nn_layer_norm(g, x, join(buffer, own, "norm"));
    y = nn_conv2d(g, y, join(buffer, own, "in"), 3 * HEADS * head_width, 1, 1, NN_BIAS);
    y = nn_group_attention(g, y, NULL, HEADS);
    return nn_add(g, x, nn_conv2d_zero(g, y, join(buffer, own, "out"), width, 1, 1, NN_BIAS));
}

nn_node *block_exchange(nn_graph *g, nn_node *x, const char *name, int width, bool attention)
{
    char buffer[NAME];
    nn_node *parts[3] = {x, nn_group_repeat(g, nn_group_max(g, x, NULL)),
                         nn_group_repeat(g, nn_group_mean(g, x, NULL))};
    nn_node *y = nn_conv2d_zero(g, nn_concat(g, parts, 3), join(buffer, name, "exchange"), width, 1, 1, NN_BIAS);
    y = nn_add(g, x, y);
    return attention ? attend(g, y, name, width, HEAD_WIDTH) : y;
}

nn_node *block_fuse(nn_graph *g, nn_node *x, const char *name, int width)
{
    nn_node *mean = nn_group_mean(g, x, NULL);
    nn_node *parts[3] = {nn_group_max(g, x, NULL), mean, nn_group_spread(g, x, NULL)};
    return nn_add(g, mean, nn_conv2d_zero(g, nn_concat(g, parts, 3), name, width, 1, 1, NN_BIAS));
}

/* Adds two fully connected layers at each pixel, in parallel to x. */
static nn_node *think(nn_graph *g, nn_node *x, const char *name, int width)
{
    char buffer[NAME];
    nn_node *y = nn_layer_norm(g, x, join(buffer, name, "norm"));
    y = nn_relu(g, nn_conv2d(g, y, join(buffer, name, "a"), 2 * width, 1, 1, NN_BIAS));
    return nn_add(g, x, nn_conv2d_zero(g, y, join(buffer, name, "b"), width, 1, 1, NN_BIAS));
}

nn_node *block_pixels(nn_graph *g, const block_pixel_inputs *in, const char *name, int channels)
{
    char buffer[NAME];
    nn_node *light = nn_linear(g, nn_compute(g, in->light), join(buffer, name, "light"), PIXEL_LIGHT);
    nn_node *parts[4] = {in->pixels, in->own, nn_group_repeat(g, in->object), nn_tile(g, nn_tanh(g, light), in->own)};
    nn_node *x = nn_conv2d(g, nn_concat(g, parts, 4), join(buffer, name, "in"), PIXEL_WIDTH, 1, 1, NN_BIAS);
    x = nn_relu(g, x);
    for (int i = 0; i < PIXEL_BLOCKS; i++) {
        char block[NAME];
        snprintf(block, sizeof block, "%.63s.block%d", name, i);
        x = attend(g, x, block, PIXEL_WIDTH, PIXEL_WIDTH / HEADS);
        x = think(g, x, block, PIXEL_WIDTH);
    }
    x = nn_layer_norm(g, x, join(buffer, name, "norm"));
    x = nn_conv2d(g, x, join(buffer, name, "values"), 2 * PIXEL_WIDTH, 1, 1, NN_BIAS);
    nn_node *both[2] = {nn_group_pool(g, x, NULL, join(buffer, name, "pool"), HEADS), in->object};
    nn_node *y = nn_conv2d(g, nn_concat(g, both, 2), join(buffer, name, "fuse"), PIXEL_WIDTH, 1, 1, NN_BIAS);
    y = nn_conv2d_zero(g, nn_relu(g, y), join(buffer, name, "head"), 4 * channels, 1, 1, NN_BIAS);
    return nn_depth_to_space(g, nn_float(g, y), 2);
}

/* Adds an attention gate (Oktay et al. 2018): sigma(psi(ReLU(W_x skip + W_g signal + b)) + b_psi), computed at the
 * coarse signal's resolution, enlarged to the skip's, times the skip. */
static nn_node *attention_gate(nn_graph *g, nn_node *skip, nn_node *signal, const char *name, int inner)
{
    char buffer[NAME];
    nn_node *x = nn_conv2d(g, skip, join(buffer, name, "skip"), inner, 1, 2, NN_NO_BIAS);
    nn_node *s = nn_conv2d(g, signal, join(buffer, name, "signal"), inner, 1, 1, NN_BIAS);
    nn_node *both = nn_relu(g, nn_add(g, x, s));
    nn_node *alpha = nn_sigmoid(g, nn_conv2d(g, both, join(buffer, name, "psi"), 1, 1, 1, NN_BIAS));
    return nn_gate(g, skip, nn_upsample_bilinear(g, alpha));
}

static nn_node *skip_through(nn_graph *g, const block_decoder_inputs *in, nn_node *skip, nn_node *signal,
                             const char *name, int inner)
{
    return in->gated ? attention_gate(g, skip, signal, name, inner) : skip;
}

void block_decoder(nn_graph *g, const block_decoder_inputs *in, nn_node *features[MODEL_LEVELS - 1])
{
    nn_node *d = in->bottleneck;
    for (int i = MODEL_LEVELS - 2; i >= 0; i--) {
        char stage[NAME], buffer[NAME];
        snprintf(stage, sizeof stage, "%.48s.level%d", in->name, i);
        int width = in->widths[i];
        nn_node *parts[3];
        int count = 0;
        /* reducing channels before upsampling costs a quarter of doing it after */
        parts[count++] = nn_upsample_bilinear(g, nn_conv2d(g, d, join(buffer, stage, "up"), width, 1, 1, NN_BIAS));
        parts[count++] = skip_through(g, in, in->skips[i], d, join(buffer, stage, "gate"), width / 2);
        if (in->shared)
            parts[count++] = skip_through(g, in, in->shared[i], d, join(buffer, stage, "shared_gate"), width / 2);
        nn_node *y = block_conv(g, nn_concat(g, parts, count), join(buffer, stage, "fuse"), width, 1);
        y = nn_add(g, y, in->skips[i]); /* residual skips S1 to S4 */
        features[i] = d = residual_blocks(g, y, stage, in->blocks ? &in->blocks[i] : NULL, width);
    }
}

nn_node *block_head(nn_graph *g, nn_node *x, const char *name, int channels)
{
    nn_node *y = nn_conv2d(g, x, name, 4 * channels, 3, 1, NN_BIAS);
    return nn_depth_to_space(g, nn_float(g, y), 2);
}
