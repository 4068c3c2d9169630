/* SPDX-License-Identifier: MIT */
/* A photograph seen by the network in several orientations, and the mean of what it says of them.
 *
 *     view_mean_new(config, size, &mean);
 *     for (int view = 0; view < views; view++) {
 *         view_put(program, 0, view, &photo, &mask);
 *         ... nn_forward, and an estimation out of its outputs ...
 *         view_mean_add(&mean, &estimation, view, 1.0f / views);
 *     }
 *
 * The network was trained on all eight and errs differently in each. */
#ifndef MERLIN_ESTIMATE_PHOTO_VIEW_H
#define MERLIN_ESTIMATE_PHOTO_VIEW_H

#include "estimate/surface/estimation.h"
#include "estimate/surface/sight.h"
#include "optics/light.h"

/* Into picture `slot` of a program's inputs, both before every run, which may overwrite them: a square photograph and
 * its mask (or a mask alone) in this orientation (optics/orientation.h), and a light as it stands to the turned
 * photograph: the target, or for maps the flash. A model of setting A leaves surroundings out. */
void view_put(nn_program *p, size_t slot, int view, const img *photo, const img *mask);
void view_put_mask(nn_program *p, size_t slot, int view, const img *mask);
void view_put_light(nn_program *p, const model_config *config, size_t slot, int view, const illumination *light);

/* What a model of any light is told of how the photograph was taken; how may be NULL. */
void view_put_sight(nn_program *p, size_t slot, int view, const sight *how, int size);

/* What the relighting decoder takes of a view (model_features), whatever the light: from picture 0 of a program of
 * MODEL_MAPS that has run, into picture `slot` of one of MODEL_RELIGHT, before every run. What out held is freed.
 * MERLIN_NO_MEMORY. */
typedef struct view_features {
    size_t counts[MODEL_FEATURES]; /* values of each; 0: the variant does without */
    float *values;
} view_features;
status view_features_take(nn_program *maps, const model_config *config, int size, view_features *out);
void view_features_put(const view_features *f, nn_program *relight, size_t slot);
void view_features_free(view_features *f);

/* Adds weight times an image of the turned frame, turned back; of unit normals, whose sum is not unit. */
void view_add(img *mean, const img *turned, int view, float weight);
void view_add_normals(img *mean, const img *turned, int view, float weight);

/* What a program that looks at one of several views is made for (nn_options): not bounces, which are the mean's own. */
extern const char *const view_outputs[];
/* The same for all of these. Zero maps of size × size: */
status view_mean_new(const model_config *config, int size, network_estimation *mean);
void view_mean_add(network_estimation *mean, const network_estimation *turned, int view, float weight);

#endif
