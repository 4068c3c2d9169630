/* SPDX-License-Identifier: MIT */
#include "model/rivals/rival.h"

#include "model/rivals/rival_li.h"
#include "model/rivals/rival_parts.h"
#include "model/rivals/rival_sang.h"

enum { LIGHT_VALUES = 3 };

/* Adds the target light's code: three fully connected layers with tanh. */
static nn_node *light_code(model_nodes *n)
{
    nn_graph *g = n->g;
    n->light = nn_input(g, "light", LIGHT_VALUES, NN_VECTOR);
    nn_node *code = nn_compute(g, n->light);
    code = nn_tanh(g, nn_linear(g, code, "lighting.fc1", 8));
    code = nn_tanh(g, nn_linear(g, code, "lighting.fc2", 32));
    return nn_tanh(g, nn_linear(g, code, "lighting.fc3", RIVAL_REFINED));
}

/* Adds the linear image: model_encode_image's is its square root. */
static nn_node *linear_image(nn_graph *g, nn_node *image)
{
    nn_node *square[3];
    for (int c = 0; c < 3; c++) {
        nn_node *one = nn_slice(g, image, c, 1);
        square[c] = nn_gate(g, one, one);
    }
    return nn_concat(g, square, 3);
}

/* Returns what a cascade sees: the image, the mask, the maps before, their rendering under the flash and, for Sang, the
 * relit image, for Li what the rendering lacks of the image. */
static nn_node *seen_of(const model_nodes *n, nn_node *image)
{
    nn_graph *g = n->g;
    const model_maps *m = &n->maps;
    nn_node *last = n->relit_direct;
    if (!last) last = nn_add(g, linear_image(g, image), nn_scale_shift(g, n->direct, -1.0f, 0.0f));
    nn_node *parts[8] = {image, n->mask, m->albedo, m->normal, m->roughness, m->depth, n->direct, last};
    return nn_stop(g, nn_gate(g, nn_concat(g, parts, 8), n->mask));
}

void rival_build(model_nodes *n, model_part part)
{
    nn_graph *g = n->g;
    n->mask = nn_input(g, "mask", 1, 1);
    n->light_position = nn_input(g, "light_position", 3, NN_VECTOR);
    nn_node *image = nn_input(g, "image", 3, 1), *first[2] = {image, n->mask};
    nn_node *light = n->config->rival == MODEL_SANG ? light_code(n) : NULL;
    nn_node *flash = nn_scale_shift(g, n->light_position, 0.0f, 0.0f); /* the flash is at the origin */
    nn_node *seen = nn_concat(g, first, 2);
    for (int stage = 0; stage <= n->config->cascades; stage++) {
        if (stage && part != MODEL_WHOLE && part != MODEL_MAPS) model_add_stage_losses(n, stage - 1);
        if (stage) seen = seen_of(n, image);
        if (light)
            rival_sang_stage(n, stage, seen, light);
        else
            rival_li_stage(n, stage, seen);
        n->direct = model_render(n, flash);
    }
    if (!light) n->indirect = rival_bounces(n);
    if (part != MODEL_TRAINING || !light) n->relit_brdf = model_render(n, n->light_position);
}
