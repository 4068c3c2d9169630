/* SPDX-License-Identifier: MIT */
/* Li, Xu, Ramamoorthi, Sunkavalli and Chandraker, SIGGRAPH Asia 2018. */
#include <stdio.h>

#include "model/rivals/rival.h"
#include "model/rivals/rival_parts.h"

enum { MAPS = 4, COARSE_BLOCKS = 3, BOUNCE_SCALES = 5, DILATED_SCALE = 3 };

static const char *const map_names[MAPS] = {"albedo", "normal", "roughness", "depth"};

static nn_node *mean_of_three(nn_graph *g, nn_node *x)
{
    nn_node *sum = nn_add(g, nn_slice(g, x, 0, 1), nn_slice(g, x, 1, 1));
    return nn_scale_shift(g, nn_add(g, sum, nn_slice(g, x, 2, 1)), 1 / 3.0f, 0.0f);
}

static void take_maps(model_network *n, nn_node *const y[MAPS])
{
    n->maps.albedo = y[0];
    n->maps.normal = nn_normalize(n->g, y[1]);
    n->maps.roughness = mean_of_three(n->g, y[2]);
    n->maps.depth = model_shape_depth(n->g, mean_of_three(n->g, y[3]));
}

static void first_stage(model_network *n, nn_node *seen)
{
    nn_node *skips[RIVAL_SCALES], *y[MAPS];
    rival_encoder(n->g, seen, "encoder", skips);
    for (int k = 0; k < MAPS; k++) {
        char name[RIVAL_NAME], head[RIVAL_NAME];
        snprintf(name, sizeof name, "material_%s", map_names[k]);
        const rival_decoder_inputs in = {name, skips[RIVAL_SCALES - 1], skips, NULL};
        y[k] = rival_head(n->g, rival_decoder(n->g, &in, NULL), rival_join(head, name, "head"), 3);
    }
    take_maps(n, y);
}

static void cascade(model_network *n, const char *stage, nn_node *seen)
{
    nn_graph *g = n->g;
    char name[RIVAL_NAME], part[RIVAL_NAME];
    nn_node *y[MAPS], *half = rival_down(g, nn_compute(g, seen), rival_join(name, stage, "level0"), RIVAL_WIDTH, 6);
    nn_node *x = rival_down(g, half, rival_join(name, stage, "level1"), RIVAL_REFINED, 6);
    x = rival_residual(g, x, stage, COARSE_BLOCKS, RIVAL_REFINED, 1);
    for (int k = 0; k < MAPS; k++) {
        rival_join(name, stage, map_names[k]);
        y[k] = rival_residual(g, x, name, COARSE_BLOCKS, RIVAL_REFINED, 1);
        nn_node *both[2] = {rival_up(g, y[k], rival_join(part, name, "level1"), RIVAL_WIDTH), half};
        y[k] = rival_up(g, nn_concat(g, both, 2), rival_join(part, name, "level0"), RIVAL_WIDTH);
        y[k] = rival_head(g, y[k], rival_join(part, name, "head"), 3);
    }
    take_maps(n, y);
}

void rival_li_stage(model_network *n, int stage, nn_node *seen)
{
    char name[RIVAL_NAME];
    snprintf(name, sizeof name, "cascade%d", stage);
    if (stage == 0)
        first_stage(n, seen);
    else
        cascade(n, name, seen);
}

/* Adds the light of the next bounce, from that of the one before. */
static nn_node *next_bounce(const model_network *n, nn_node *before, const char *name)
{
    static const int down[BOUNCE_SCALES] = {64, 64, 128, 256, 256}, up[BOUNCE_SCALES] = {64, 32, 64, 128, 256};
    nn_graph *g = n->g;
    const model_maps *m = &n->maps;
    nn_node *parts[6] = {
        before, nn_stop(g, m->albedo), nn_stop(g, m->normal), nn_stop(g, m->roughness), nn_stop(g, m->depth), n->mask};
    nn_node *x = nn_compute(g, nn_gate(g, nn_concat(g, parts, 6), n->mask)), *skips[BOUNCE_SCALES];
    char part[RIVAL_NAME], level[32];
    for (int i = 0; i < BOUNCE_SCALES; i++) {
        snprintf(level, sizeof level, "down%d", i);
        x = rival_down(g, x, rival_join(part, name, level), down[i], i ? 4 : 6);
        if (i == DILATED_SCALE) x = rival_same(g, x, rival_join(part, name, "dilated"), down[i], 3);
        skips[i] = x;
    }
    for (int i = BOUNCE_SCALES - 1; i >= 0; i--) {
        snprintf(level, sizeof level, "up%d", i);
        x = rival_up(g, x, rival_join(part, name, level), up[i]);
        nn_node *both[2] = {x, i ? skips[i - 1] : NULL};
        if (i) x = nn_concat(g, both, 2);
    }
    nn_node *y = nn_float(g, nn_conv2d(g, x, rival_join(part, name, "head"), 3, 5, 1, NN_BIAS));
    /* indirect light is a few percent of direct: small from the first step on */
    return nn_gate(g, nn_scale_shift(g, y, 0.1f, 0.0f), n->mask);
}

nn_node *rival_bounces(const model_network *n)
{
    nn_node *second = next_bounce(n, nn_stop(n->g, n->direct), "bounce2");
    return nn_add(n->g, second, next_bounce(n, nn_stop(n->g, second), "bounce3"));
}
