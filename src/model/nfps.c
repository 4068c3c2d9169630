/* SPDX-License-Identifier: MIT */
#include "model/nfps.h"

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

/* A picture's features at half and a quarter of the size. */
typedef struct seen {
    nn_node *half, *quarter;
} seen;

/* Adds what sees each picture by itself. */
static seen see_picture(const stage *s, nn_node *normal, nn_node *mask)
{
    nn_graph *g = s->g;
    const int width = s->width;
    nn_node *parts[4] = {picture_input(s, "picture", NFPS_PICTURE), picture_input(s, "light", NFPS_LIGHT),
                         nn_group_repeat(g, mask), NULL};
    if (normal) parts[3] = nn_group_repeat(g, normal);
    nn_node *x = nn_compute(g, nn_space_to_depth(g, nn_concat(g, parts, normal ? 4 : 3), 2));
    nn_node *half = residual(s, conv(s, x, ".picture.half", width, 1), ".picture.half_block", width);
    x = residual(s, conv(s, half, ".picture.quarter", 2 * width, 2), ".picture.quarter_block", 2 * width);
    return (seen){half, conv(s, x, ".picture.last", 2 * width, 1)};
}

/* Normals of the object that a stage starts from, as inputs. */
typedef struct start {
    nn_node *matte;  /* NFPS_MATTE channels */
    nn_node *normal; /* of the scale before, or NULL */
} start;

/* Adds to features at half the size what is seen there: the pictures' maximum and mean, the matte normal, the normal so
 * far. It adds nothing until it is trained. */
static nn_node *add_detail(const stage *s, nn_node *x, nn_node *half, start from)
{
    nn_graph *g = s->g;
    char buffer[NAME_SIZE];
    nn_node *maps[2] = {from.matte, from.normal};
    nn_node *packed = nn_compute(g, nn_space_to_depth(g, nn_concat(g, maps, from.normal ? 2 : 1), 2));
    nn_node *parts[3] = {nn_group_max(g, half, NULL), nn_group_mean(g, half, NULL), packed};
    const char *name = named(buffer, s->name, ".object.detail");
    return nn_add(g, x, nn_conv2d_zero(g, nn_concat(g, parts, 3), name, s->width, 3, 1, NN_BIAS));
}

/* Adds features of the object, at half the size, from those of its pictures. */
static nn_node *see_object(const stage *s, seen pictures, start from)
{
    nn_graph *g = s->g;
    const int width = s->width;
    nn_node *parts[2] = {nn_group_max(g, pictures.quarter, NULL), nn_group_mean(g, pictures.quarter, NULL)};
    nn_node *x = conv(s, nn_concat(g, parts, 2), ".object.quarter", 2 * width, 1);
    x = residual(s, residual(s, x, ".object.quarter_block0", 2 * width), ".object.quarter_block1", 2 * width);
    x = conv(s, nn_upsample_bilinear(g, x), ".object.half", width, 1);
    x = add_detail(s, x, pictures.half, from);
    return residual(s, residual(s, x, ".object.half_block0", width), ".object.half_block1", width);
}

/* Adds normals: a mixture of the matte one and that of the scale before, at each pixel as the features say, and a
 * correction. Until it is trained, MATTE_FIRST is the logit of the matte one's share. */
static nn_node *make_normal(const stage *s, nn_node *features, start from)
{
    static const float MATTE_FIRST = 2;
    nn_graph *g = s->g;
    char buffer[NAME_SIZE];
    const char *name = named(buffer, s->name, ".object.correction");
    nn_node *packed = nn_conv2d_zero(g, features, name, 4 * (from.normal ? 4 : 3), 3, 1, NN_BIAS);
    nn_node *x = nn_depth_to_space(g, nn_float(g, packed), 2), *base = nn_slice(g, from.matte, 0, 3);
    if (!from.normal) return nn_normalize(g, nn_add(g, base, x));
    nn_node *share = nn_sigmoid(g, nn_scale_shift(g, nn_slice(g, x, 3, 1), 1, MATTE_FIRST));
    nn_node *other = nn_add(g, base, nn_scale_shift(g, from.normal, -1, 0));
    base = nn_add(g, from.normal, nn_gate(g, other, share));
    return nn_normalize(g, nn_add(g, base, nn_slice(g, x, 0, 3)));
}

static nn_node *add_stage(const stage *s)
{
    nn_node *mask = object_input(s, "mask", 1);
    const start from = {object_input(s, "matte", NFPS_MATTE), s->refines ? object_input(s, "normal", 3) : NULL};
    return make_normal(s, see_object(s, see_picture(s, from.normal, mask), from), from);
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
