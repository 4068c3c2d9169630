/* SPDX-License-Identifier: MIT */
#include "model/nfps/nfps.h"

#include <stdio.h>

#include "model/blocks.h"

enum { NAME_SIZE = 48 };

/* One of the two stages: its inputs' names begin with `prefix`, its parameters' with `name`. */
typedef struct stage {
    nn_graph *g;
    const char *prefix, *name;
    int width, reduction;
    bool refines; /* it gets normals to improve */
} stage;

static const char *named(char buffer[NAME_SIZE], const char *prefix, const char *name)
{
    snprintf(buffer, NAME_SIZE, "%s%s", prefix, name);
    return buffer;
}

static nn_node *picture_input(const stage *s, const char *name, int channels)
{
    char buffer[NAME_SIZE];
    return nn_input(s->g, named(buffer, s->prefix, name), channels, s->reduction);
}

static nn_node *object_input(const stage *s, const char *name, int channels)
{
    char buffer[NAME_SIZE];
    return nn_group_input(s->g, named(buffer, s->prefix, name), channels, s->reduction);
}

static nn_node *conv(const stage *s, nn_node *x, const char *name, int out, int stride)
{
    char buffer[NAME_SIZE];
    return block_conv(s->g, x, named(buffer, s->name, name), out, stride);
}

static nn_node *residual(const stage *s, nn_node *x, const char *name, int width)
{
    char buffer[NAME_SIZE];
    return block_residual(s->g, x, named(buffer, s->name, name), width);
}

/* Adds what sees each picture by itself: features at a quarter of the size. */
static nn_node *see_picture(const stage *s, nn_node *normal, nn_node *mask)
{
    nn_graph *g = s->g;
    const int width = s->width;
    nn_node *parts[4] = {picture_input(s, "picture", NFPS_PICTURE), picture_input(s, "light", NFPS_LIGHT),
                         nn_group_repeat(g, mask), NULL};
    if (normal) parts[3] = nn_group_repeat(g, normal);
    nn_node *x = nn_compute(g, nn_space_to_depth(g, nn_concat(g, parts, normal ? 4 : 3), 2));
    x = residual(s, conv(s, x, ".picture.half", width, 1), ".picture.half_block", width);
    x = residual(s, conv(s, x, ".picture.quarter", 2 * width, 2), ".picture.quarter_block", 2 * width);
    return conv(s, x, ".picture.last", 2 * width, 1);
}

/* Adds what makes normals of the pictures' maximum and mean. */
static nn_node *make_normal(const stage *s, nn_node *seen, nn_node *normal)
{
    nn_graph *g = s->g;
    const int width = s->width;
    char buffer[NAME_SIZE];
    nn_node *parts[2] = {nn_group_max(g, seen, NULL), nn_group_mean(g, seen, NULL)};
    nn_node *x = conv(s, nn_concat(g, parts, 2), ".object.quarter", 2 * width, 1);
    x = residual(s, residual(s, x, ".object.quarter_block0", 2 * width), ".object.quarter_block1", 2 * width);
    x = conv(s, nn_upsample_bilinear(g, x), ".object.half", width, 1);
    x = residual(s, residual(s, x, ".object.half_block0", width), ".object.half_block1", width);
    x = block_head(g, x, named(buffer, s->name, ".object.head"), 3);
    return nn_normalize(g, normal ? nn_add(g, normal, x) : x);
}

static nn_node *add_stage(const stage *s)
{
    nn_node *mask = object_input(s, "mask", 1), *normal = s->refines ? object_input(s, "normal", 3) : NULL;
    return make_normal(s, see_picture(s, normal, mask), normal);
}

static void add_loss(const stage *s, nn_node *normal)
{
    char buffer[NAME_SIZE];
    nn_node *truth = object_input(s, "normal_true", 3), *mask = object_input(s, "loss_mask", 1);
    nn_masked_l2(s->g, normal, truth, mask, named(buffer, s->prefix, "normal"), 1.0f);
}

status nfps_build(nn_graph *g, const model_config *config, model_part part)
{
    const bool trains = part == MODEL_TRAINING || part == MODEL_TRAINING_BRDF || part == MODEL_TRAINING_SSIM;
    const bool both = part == MODEL_WHOLE || trains;
    if (!both && part != MODEL_FIRST && part != MODEL_REFINE)
        return fail(MERLIN_WRONG_USE,
                    "model \"%s\" is for pictures under known lights, and makes no maps of photographs", config->name);
    const stage first = {g, both ? "first_" : "", "first", config->nfps_width, both ? 2 : 1, false},
                refining = {g, "", "refine", config->nfps_width, 1, true};
    const stage *const stages[] = {&first, &refining};
    for (int i = 0; i < 2; i++) {
        char buffer[NAME_SIZE];
        if (part == (i == 0 ? MODEL_REFINE : MODEL_FIRST)) continue;
        nn_node *normal = add_stage(stages[i]);
        nn_output(g, normal, named(buffer, stages[i]->prefix, "normal"));
        if (trains) add_loss(stages[i], normal);
    }
    return OK;
}
