/* SPDX-License-Identifier: MIT */
/* The network alone, as the paper measures it: the picture at its own size, its exposure known exactly, and nothing
 * smoothed, fused or refined afterwards.
 *
 *     status s = raw_estimate(model, &photo, views, &maps);
 *     if (s == OK) s = raw_features(model, &photo, views, &features);
 *     if (s == OK && features) s = network_relight(model->network, features, &light, &direct);
 *
 * Its maps stand where merlin_estimate's would, so that whatever is made of them is the same. */
#ifndef MERLIN_LAB_EVAL_SAMPLES_RAW_H
#define MERLIN_LAB_EVAL_SAMPLES_RAW_H

#include "estimate/photo/model_pair.h"
#include "lab/eval/samples/photograph.h"

/* Sees the photograph: a whole one, its mask 0 or 1, its side a multiple of MODEL_SIZE_MULTIPLE. The maps are the mean
 * of so many views, as the network says them; the reconstruction is lit by its flash, and by the surroundings that it
 * found. */
status raw_estimate(merlin_model *model, const eval_photo *photo, int views, merlin_maps *maps);
/* Takes what the relighting decoder wants of it; NULL for a model without. */
status raw_features(merlin_model *model, const eval_photo *photo, int views, network_features **out);

#endif
