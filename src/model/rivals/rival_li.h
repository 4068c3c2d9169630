/* SPDX-License-Identifier: MIT */
/* Stages of Li et al. 2018, and its networks of bounces. */
#ifndef MERLIN_MODEL_RIVALS_RIVAL_LI_H
#define MERLIN_MODEL_RIVALS_RIVAL_LI_H

#include "model/model_network.h"

/* Adds a stage's maps. stage: 0 or the cascade. seen: what the stage sees, float. Parameters are named by the stage. */
void rival_li_stage(model_nodes *n, int stage, nn_node *seen);

/* Adds the two networks that predict the light of bounces 2 and 3 from the rendering and the maps. */
nn_node *rival_bounces(const model_nodes *n);

#endif
