/* SPDX-License-Identifier: MIT */
/* Sang and Chandraker, ECCV 2020. */
#include <stdio.h>

#include "model/rivals/rival.h"
#include "model/rivals/rival_parts.h"

enum { BRDF_CHANNELS = 12, COARSE_BLOCKS = 3 };

static nn_node *mean_of_three(nn_graph *g, nn_node *x, int first)
{
    nn_node *sum = nn_add(g, nn_slice(g, x, first, 1), nn_slice(g, x, first + 1, 1));
    return nn_scale_shift(g, nn_add(g, sum, nn_slice(g, x, first + 2, 1)), 1 / 3.0f, 0.0f);
}

/* Reads the maps from three channels each of albedo, normal, roughness and depth. */
static void take_maps(model_network *n, nn_node *y)
{
    nn_graph *g = n->g;
    n->maps.albedo = nn_slice(g, y, 0, 3);
    n->maps.normal = nn_normalize(g, nn_slice(g, y, 3, 3));
    n->maps.roughness = mean_of_three(g, y, 6);
    n->maps.depth = model_shape_depth(g, mean_of_three(g, y, 9));
}

static void take_relit(model_network *n, nn_node *y)
{
    n->relit_direct = nn_gate(n->g, nn_scale_shift(n->g, y, 0.5f, 0.5f), n->mask);
}

static void first_stage(model_network *n, nn_node *seen, nn_node *light)
{
    nn_graph *g = n->g;
    nn_node *skips[RIVAL_SCALES], *shared[RIVAL_SCALES - 1];
    rival_encoder(g, seen, "encoder", skips);
    nn_node *deepest = skips[RIVAL_SCALES - 1], *parts[2] = {deepest, nn_tile(g, light, deepest)};
    const rival_decoder_inputs material = {"material", deepest, skips, NULL};
    nn_node *y = rival_decoder(g, &material, shared);
    y = rival_residual(g, y, "material", 1, RIVAL_WIDTH, 2);
    take_maps(n, rival_head(g, y, "material.head", BRDF_CHANNELS));
    const rival_decoder_inputs relight = {"relight", nn_concat(g, parts, 2), skips, shared};
    y = rival_residual(g, rival_decoder(g, &relight, NULL), "relight", 3, RIVAL_WIDTH, 2);
    take_relit(n, rival_head(g, y, "relight.head", 3));
}

/* Adds a cascade's decoder from 1/4 of the size; beside: features at 1/2 that are added as channels. Returns those of
 * full size, and its own at 1/2. */
static nn_node *refine(nn_graph *g, nn_node *x, const char *name, nn_node *const *beside, int count, nn_node **half)
{
    char buffer[RIVAL_NAME];
    nn_node *y = rival_residual(g, x, name, COARSE_BLOCKS, RIVAL_REFINED, 1);
    nn_node *parts[3] = {rival_up(g, y, rival_join(buffer, name, "level1"), RIVAL_WIDTH)};
    for (int i = 0; i < count; i++)
        parts[i + 1] = beside[i];
    *half = parts[0];
    return rival_up(g, nn_concat(g, parts, count + 1), rival_join(buffer, name, "level0"), RIVAL_WIDTH);
}

static void cascade(model_network *n, const char *stage, nn_node *seen, nn_node *light)
{
    nn_graph *g = n->g;
    char name[RIVAL_NAME], part[RIVAL_NAME];
    nn_node *half[2], *x = nn_compute(g, seen), *unused;
    half[0] = x = rival_down(g, x, rival_join(name, stage, "level0"), RIVAL_WIDTH, 6);
    x = rival_down(g, x, rival_join(name, stage, "level1"), RIVAL_REFINED, 6);
    x = rival_residual(g, x, stage, COARSE_BLOCKS, RIVAL_REFINED, 1);
    rival_join(name, stage, "material");
    nn_node *y = refine(g, x, name, half, 1, &half[1]);
    take_maps(n, rival_head(g, y, rival_join(part, name, "head"), BRDF_CHANNELS));
    rival_join(name, stage, "relight");
    nn_node *lit[2] = {x, nn_tile(g, light, x)};
    x = rival_same(g, nn_concat(g, lit, 2), rival_join(part, name, "light"), RIVAL_REFINED, 1);
    y = refine(g, x, name, half, 2, &unused);
    take_relit(n, rival_head(g, y, rival_join(part, name, "head"), 3));
}

void rival_sang_stage(model_network *n, int stage, nn_node *seen, nn_node *light)
{
    char name[RIVAL_NAME];
    snprintf(name, sizeof name, "cascade%d", stage);
    if (stage == 0)
        first_stage(n, seen, light);
    else
        cascade(n, name, seen, light);
}
