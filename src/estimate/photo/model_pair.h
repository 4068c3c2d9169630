/* SPDX-License-Identifier: MIT */
/* A model as merlin/model.h opens it: one network, or two of which one is better for flash photographs. */
#ifndef MERLIN_ESTIMATE_PHOTO_MODEL_PAIR_H
#define MERLIN_ESTIMATE_PHOTO_MODEL_PAIR_H

#include "estimate/photo/network.h"
#include "merlin/merlin.h"

struct merlin_model {
    network *network;
    network *flash;   /* network for photographs lit by a flash only; NULL: `network` is used for them, too */
    network *several; /* network that compares several photographs; NULL: `network` sees them one by one */
};

/* Opens a model. flash: weights for merlin_model_add_flash, or NULL. */
status model_open_pair(const char *weights, const char *flash, merlin_model **out);

/* Opens a model of any light. several: weights for merlin_model_add_several, or NULL. */
status model_open_several(const char *weights, const char *several, merlin_model **out);

/* Returns the network that made the maps; for maps of another origin that for flashes, whose bounces need only a
 * flash's direct light. For relighting by the decoder it is the one that has a decoder. */
network *model_network(const merlin_model *model, const merlin_maps *maps, merlin_relighting how);

/* Closes that of its networks which is not `kept`, as no photograph follows that needs it. */
void model_keep(merlin_model *model, network *kept);

#endif
