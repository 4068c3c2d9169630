/* SPDX-License-Identifier: MIT */
#include "model/rivals/rival_parts.h"

#include <stdio.h>

#include "model/rivals/rival.h"

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
