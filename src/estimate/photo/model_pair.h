/* SPDX-License-Identifier: MIT */
/* A model as merlin/model.h opens it: one network, or two of which one knows flashes better. */
#ifndef MERLIN_ESTIMATE_PHOTO_MODEL_PAIR_H
#define MERLIN_ESTIMATE_PHOTO_MODEL_PAIR_H

#include "estimate/photo/network.h"
#include "merlin/merlin.h"

struct merlin_model {
    network *network;
    network *flash; /* for photographs lit by a flash alone; NULL: `network` sees them, too */
};

/* flash: weights for merlin_model_add_flash, or NULL. */
status model_open_pair(const char *weights, const char *flash, merlin_model **out);

/* Returns the network that made the maps; for maps of others the flash's, which knows how light goes on between
 * surfaces where a flash's is all it is given. To relight by the decoder it is one that has it. */
network *model_network(const merlin_model *model, const merlin_maps *maps, merlin_relighting how);

/* Closes that of its networks which is not `kept`: no photograph follows that would want it. */
void model_keep(merlin_model *model, network *kept);

#endif
