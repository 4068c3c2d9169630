/* SPDX-License-Identifier: MIT */
/* Sang and Chandraker, ECCV 2020. */
#include "model/rivals/rival_sang.h"

#include <stdio.h>

#include "model/rivals/rival_parts.h"

enum { BRDF_CHANNELS = 12 };

static void take_maps(model_nodes *n, nn_node *y)
{
    nn_node *parts[4];
    for (int k = 0; k < 4; k++)
        parts[k] = nn_slice(n->g, y, 3 * k, 3);
    rival_take_maps(n, parts);
}

static void take_relit(model_nodes *n, nn_node *y)
{
    n->relit_direct = nn_gate(n->g, nn_scale_shift(n->g, y, 0.5f, 0.5f), n->mask);
}

static void first_stage(model_nodes *n, nn_node *seen, nn_node *light)
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

static void cascade(model_nodes *n, const char *stage, nn_node *seen, nn_node *light)
{
    nn_graph *g = n->g;
    char name[RIVAL_NAME], part[RIVAL_NAME];
    nn_node *half, *own, *x = rival_refining_encoder(g, seen, stage, &half);
    rival_join(name, stage, "material");
    take_maps(n, rival_refine(g, &(rival_refining){name, x, {half, NULL}, BRDF_CHANNELS}, &own));
    rival_join(name, stage, "relight");
    nn_node *lit[2] = {x, nn_tile(g, light, x)};
    x = rival_same(g, nn_concat(g, lit, 2), rival_join(part, name, "light"), RIVAL_REFINED, 1);
    take_relit(n, rival_refine(g, &(rival_refining){name, x, {half, own}, 3}, NULL));
}

void rival_sang_stage(model_nodes *n, int stage, nn_node *seen, nn_node *light)
{
    char name[RIVAL_NAME];
    snprintf(name, sizeof name, "cascade%d", stage);
    if (stage == 0)
        first_stage(n, seen, light);
    else
        cascade(n, name, seen, light);
}
