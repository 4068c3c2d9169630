/* SPDX-License-Identifier: MIT */
/* Stages of Sang and Chandraker 2020. */
#ifndef MERLIN_MODEL_RIVALS_RIVAL_SANG_H
#define MERLIN_MODEL_RIVALS_RIVAL_SANG_H

#include "model/model_network.h"

/* Adds a stage's maps, and its relit image. stage: 0 or the cascade. seen: what the stage sees, float; light: the
 * target's code, RIVAL_REFINED values. Parameters are named by the stage. */
void rival_sang_stage(model_nodes *n, int stage, nn_node *seen, nn_node *light);

#endif
