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

/* Builds the network of n->config->rival into n. */
void rival_build(model_nodes *n, model_part part);

#endif
