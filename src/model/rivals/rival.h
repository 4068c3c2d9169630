/* SPDX-License-Identifier: MIT */
/* The paper's rivals as graphs: the networks of Li et al. (SIGGRAPH Asia 2018) and of Sang and Chandraker (ECCV 2020),
 * with the inputs, outputs and losses of model.h. Their first stage gives an estimate, and each cascade a better one
 * from the image and the estimate before. A stage learns beside the one before without changing it, in place of one
 * after the other; all have the same losses. Depth reaches further to the front than published (model_network.h).
 *
 * Sang: an encoder, a BRDF decoder, and a relighting decoder that gets the BRDF decoder's features and the light.
 * Li: an encoder with four decoders; two networks, learned apart, predict the second bounce from the first and the
 * third from the second, for the last stage. Sizes are multiples of 64. */
#ifndef MERLIN_MODEL_RIVALS_RIVAL_H
#define MERLIN_MODEL_RIVALS_RIVAL_H

#include "model/model_network.h"

enum { RIVAL_SCALES = 6, RIVAL_WIDTH = 64, RIVAL_REFINED = 128 };

/* Builds the network of n->config->rival into n. */
void rival_build(model_nodes *n, model_part part);

/* Add a stage's maps, and what relights (Sang). stage: 0 or the cascade. seen: what the stage sees, float; light: the
 * target's code, RIVAL_REFINED values, NULL for Li. Parameters are named by the stage. */
void rival_li_stage(model_nodes *n, int stage, nn_node *seen);
void rival_sang_stage(model_nodes *n, int stage, nn_node *seen, nn_node *light);

/* Adds Li's two networks, which predict the light of bounces 2 and 3 from the rendering and the maps. */
nn_node *rival_bounces(const model_nodes *n);

#endif
