/* SPDX-License-Identifier: MIT */
/* A network under construction: its inputs, and the nodes that are outputs and that losses compare. Internal to
 * src/model. */
#ifndef MERLIN_MODEL_MODEL_NETWORK_H
#define MERLIN_MODEL_MODEL_NETWORK_H

#include "model/model_part.h"
#include "nn/nn.h"

typedef struct model_maps {
    nn_node *albedo, *normal, *roughness, *depth; /* float, full size */
} model_maps;

/* Inputs that predictions are compared with. */
typedef struct model_truth {
    nn_node *mask, *albedo, *normal, *roughness, *depth, *relit;
} model_truth;

typedef struct model_nodes {
    nn_graph *g;
    const model_config *config;
    nn_node *mask, *light_position;
    nn_node *sight, *lens;               /* NULL unless "lighting" is "any" */
    nn_node *pixels;                     /* what the decoder by pixel sees of each picture; NULL unless "several" */
    nn_node *seen[MODEL_LEVELS];         /* encoder's features of each picture */
    nn_node *encoder[MODEL_LEVELS];      /* those of the object: of several pictures together, else the same */
    nn_node *material[MODEL_LEVELS - 1]; /* features of the material decoder, or the sum of those of four decoders */
    model_maps maps;
    nn_node *light;                          /* the target's lighting code */
    nn_node *environment_code, *environment; /* NULL unless for both lights */
    nn_node *lights, *visibility;            /* NULL unless "lighting" is "any" */
    nn_node *direct, *indirect, *relit_direct, *relit_brdf;
    model_truth truth; /* zero until there are losses */
} model_nodes;

/* Adds an input that is the same for all pictures of an object. */
nn_node *model_object_input(const model_nodes *n, const char *name, int channels, int reduction);

/* Adds depth = 1 / (0.4 (y + 1) + 0.25) with y = 3 x + 2, x in [-1, 1]: from 0.38 to 4. With y = x, as published, the
 * nearest depth would be 0.95, behind the front of an object at 1. */
nn_node *model_shape_depth(nn_graph *g, nn_node *x);

/* Adds the image of the maps under a point light, by the rendering layer. */
nn_node *model_render(const model_nodes *n, nn_node *light);

/* Adds the paper's losses, weight 2 for normals and 1 for the rest, and the additional ones. */
void model_add_losses(model_nodes *n, model_part part);
/* Adds losses of the maps, and of the relighting network, of a stage that is not the last, under names of their own. */
void model_add_stage_losses(model_nodes *n, int stage);

#endif
