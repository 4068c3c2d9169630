/* SPDX-License-Identifier: MIT */
#include "model/rivals/rival_parts.h"

#include <stdio.h>

enum { COARSE_BLOCKS = 3 };

static const int encoder_widths[RIVAL_SCALES] = {32, 64, 128, 256, 256, 512};
static const int decoder_widths[RIVAL_SCALES] = {RIVAL_WIDTH, 32, 64, 128, 256, 256}; /* at full size, 1/2, … */

const char *rival_join(char *buffer, const char *a, const char *b)
{
    snprintf(buffer, RIVAL_NAME, "%.63s.%.31s", a, b);
    return buffer;
}

static nn_node *finish(nn_graph *g, nn_node *y, const char *name)
{
    char buffer[RIVAL_NAME];
    return nn_relu(g, nn_batch_norm(g, y, rival_join(buffer, name, "norm")));
}

nn_node *rival_down(nn_graph *g, nn_node *x, const char *name, int out, int kernel)
{
    char buffer[RIVAL_NAME];
    return finish(g, nn_conv2d(g, x, rival_join(buffer, name, "conv"), out, kernel, 2, NN_NO_BIAS), name);
}

nn_node *rival_up(nn_graph *g, nn_node *x, const char *name, int out)
{
    char buffer[RIVAL_NAME];
    return finish(g, nn_conv2d_transposed(g, x, rival_join(buffer, name, "conv"), out, 4, 2), name);
}

nn_node *rival_same(nn_graph *g, nn_node *x, const char *name, int out, int dilation)
{
    char buffer[RIVAL_NAME];
    return finish(g, nn_conv2d_dilated(g, x, rival_join(buffer, name, "conv"), out, 3, dilation, NN_NO_BIAS), name);
}

nn_node *rival_residual(nn_graph *g, nn_node *x, const char *name, int count, int width, int dilation)
{
    for (int i = 0; i < count; i++) {
        char block[RIVAL_NAME], buffer[RIVAL_NAME];
        snprintf(block, sizeof block, "%.63s.block%d", name, i);
        nn_node *y = rival_same(g, x, rival_join(buffer, block, "a"), width, dilation);
        y = nn_conv2d_dilated(g, y, rival_join(buffer, block, "b.conv"), width, 3, dilation, NN_NO_BIAS);
        y = nn_batch_norm(g, y, rival_join(buffer, block, "b.norm"));
        x = nn_relu(g, nn_add(g, x, y));
    }
    return x;
}

nn_node *rival_head(nn_graph *g, nn_node *x, const char *name, int channels)
{
    return nn_tanh(g, nn_float(g, nn_conv2d(g, x, name, channels, 5, 1, NN_BIAS)));
}

void rival_encoder(nn_graph *g, nn_node *x, const char *name, nn_node **features)
{
    nn_node *y = nn_compute(g, x);
    for (int i = 0; i < RIVAL_SCALES; i++) {
        char level[RIVAL_NAME];
        snprintf(level, sizeof level, "%.63s.level%d", name, i);
        features[i] = y = rival_down(g, y, level, encoder_widths[i], i ? 4 : 6);
    }
}

nn_node *rival_decoder(nn_graph *g, const rival_decoder_inputs *in, nn_node **own)
{
    nn_node *y = in->bottleneck;
    for (int i = RIVAL_SCALES - 1; i >= 0; i--) {
        char level[RIVAL_NAME];
        snprintf(level, sizeof level, "%.63s.level%d", in->name, i);
        y = rival_up(g, y, level, decoder_widths[i]);
        if (i == 0) break;
        if (own) own[i - 1] = y;
        nn_node *parts[3] = {y, in->skips[i - 1], in->shared ? in->shared[i - 1] : NULL};
        y = nn_concat(g, parts, in->shared ? 3 : 2);
    }
    return y;
}

nn_node *rival_refining_encoder(nn_graph *g, nn_node *seen, const char *name, nn_node **half)
{
    char level[RIVAL_NAME];
    *half = rival_down(g, nn_compute(g, seen), rival_join(level, name, "level0"), RIVAL_WIDTH, 6);
    nn_node *x = rival_down(g, *half, rival_join(level, name, "level1"), RIVAL_REFINED, 6);
    return rival_residual(g, x, name, COARSE_BLOCKS, RIVAL_REFINED, 1);
}

nn_node *rival_refine(nn_graph *g, const rival_refining *in, nn_node **half)
{
    char part[RIVAL_NAME];
    nn_node *y = rival_residual(g, in->from, in->name, COARSE_BLOCKS, RIVAL_REFINED, 1);
    nn_node *parts[3] = {rival_up(g, y, rival_join(part, in->name, "level1"), RIVAL_WIDTH), in->beside[0],
                         in->beside[1]};
    if (half) *half = parts[0];
    y = nn_concat(g, parts, in->beside[1] ? 3 : 2);
    y = rival_up(g, y, rival_join(part, in->name, "level0"), RIVAL_WIDTH);
    return rival_head(g, y, rival_join(part, in->name, "head"), in->channels);
}

static nn_node *mean_of_three(nn_graph *g, nn_node *x)
{
    nn_node *sum = nn_add(g, nn_slice(g, x, 0, 1), nn_slice(g, x, 1, 1));
    return nn_scale_shift(g, nn_add(g, sum, nn_slice(g, x, 2, 1)), 1 / 3.0f, 0.0f);
}

void rival_take_maps(model_nodes *n, nn_node *const y[4])
{
    n->maps.albedo = y[0];
    n->maps.normal = nn_normalize(n->g, y[1]);
    n->maps.roughness = mean_of_three(n->g, y[2]);
    n->maps.depth = model_shape_depth(n->g, mean_of_three(n->g, y[3]));
}
