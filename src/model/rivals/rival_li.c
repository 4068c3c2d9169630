/* SPDX-License-Identifier: MIT */
/* Li, Xu, Ramamoorthi, Sunkavalli and Chandraker, SIGGRAPH Asia 2018. */
#include "model/rivals/rival_li.h"

#include <stdio.h>

#include "model/rivals/rival_parts.h"

enum { MAPS = 4, BOUNCE_SCALES = 5, DILATED_SCALE = 3 };

static const char *const map_names[MAPS] = {"albedo", "normal", "roughness", "depth"};

static void first_stage(model_nodes *n, nn_node *seen)
{
    nn_node *skips[RIVAL_SCALES], *y[MAPS];
    rival_encoder(n->g, seen, "encoder", skips);
    for (int k = 0; k < MAPS; k++) {
        char name[RIVAL_NAME], head[RIVAL_NAME];
        snprintf(name, sizeof name, "material_%s", map_names[k]);
        const rival_decoder_inputs in = {name, skips[RIVAL_SCALES - 1], skips, NULL};
        y[k] = rival_head(n->g, rival_decoder(n->g, &in, NULL), rival_join(head, name, "head"), 3);
    }
    rival_take_maps(n, y);
}

static void cascade(model_nodes *n, const char *stage, nn_node *seen)
{
    nn_node *y[MAPS], *half, *x = rival_refining_encoder(n->g, seen, stage, &half);
    for (int k = 0; k < MAPS; k++) {
        char name[RIVAL_NAME];
        rival_join(name, stage, map_names[k]);
        y[k] = rival_refine(n->g, &(rival_refining){name, x, {half, NULL}, 3}, NULL);
    }
    rival_take_maps(n, y);
}

void rival_li_stage(model_nodes *n, int stage, nn_node *seen)
{
    char name[RIVAL_NAME];
    snprintf(name, sizeof name, "cascade%d", stage);
    if (stage == 0)
        first_stage(n, seen);
    else
        cascade(n, name, seen);
}

/* Adds the light of the next bounce, from that of the one before. */
static nn_node *next_bounce(const model_nodes *n, nn_node *before, const char *name)
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

nn_node *rival_bounces(const model_nodes *n)
{
    nn_node *second = next_bounce(n, nn_stop(n->g, n->direct), "bounce2");
    return nn_add(n->g, second, next_bounce(n, nn_stop(n->g, second), "bounce3"));
}
