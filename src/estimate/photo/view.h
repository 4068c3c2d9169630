/* SPDX-License-Identifier: MIT */
/* A photograph estimated by the network in several orientations, and the mean of the estimates.
 *
 *     view_mean_new(config, size, &mean);
 *     for (int view = 0; view < views; view++) {
 *         view_put(program, 0, view, &photo, &mask);
 *         ... nn_forward, and an estimation from its outputs ...
 *         view_mean_add(&mean, &estimation, view, 1.0f / views);
 *     }
 *
 * The network was trained on all eight orientations and has different errors in each. */
#ifndef MERLIN_ESTIMATE_PHOTO_VIEW_H
#define MERLIN_ESTIMATE_PHOTO_VIEW_H

#include "estimate/surface/estimation.h"
#include "estimate/surface/sight.h"
#include "optics/light.h"

/* Write picture `slot` of a program's inputs, both before every run, as a run may overwrite them: a square photograph
 * and its mask (or only a mask) in this orientation (optics/orientation.h), and a light in the frame of the rotated
 * photograph: the target, or for maps the flash. A model of setting A ignores environments. */
void view_put(nn_program *p, size_t slot, int view, const img *photo, const img *mask);
void view_put_mask(nn_program *p, size_t slot, int view, const img *mask);
void view_put_photo(nn_program *p, size_t slot, int view, const img *photo);
void view_put_light(nn_program *p, const model_config *config, size_t slot, int view, const illumination *light);

/* Writes what is known about the camera for a model of any light; how may be NULL. The second writes only what belongs
 * to the photograph, the third only what belongs to the object, of which a model of several photographs sees more. */
void view_put_sight(nn_program *p, size_t slot, int view, const sight *how, int size);
void view_put_known(nn_program *p, size_t slot, int view, const sight *how, int size);
void view_put_lens(nn_program *p, size_t slot, int view, const sight *how);

/* Writes each pixel's share of the pictures' light (model_encode_shares) for a model of several photographs, after all
 * pictures of an object; does nothing for other models. */
void view_put_shares(nn_program *p, int pictures, int size);

/* Features of a view for the relighting decoder (model_features), which do not depend on the light: read from picture 0
 * of a program of MODEL_MAPS that has run, and written into picture `slot` of one of MODEL_RELIGHT before every run.
 * The previous content of out is freed. MERLIN_NO_MEMORY. */
typedef struct view_features {
    size_t counts[MODEL_FEATURES]; /* number of values of each; 0: the variant has none */
    float *values;
} view_features;
status view_features_take(nn_program *maps, const model_config *config, int size, view_features *out);
void view_features_put(const view_features *f, nn_program *relight, size_t slot);
void view_features_free(view_features *f);

/* Adds weight times an image, rotated back; the sum of unit normals is not unit. */
void view_add(img *mean, const img *turned, int view, float weight);
void view_add_normals(img *mean, const img *turned, int view, float weight);

/* Outputs (nn_options) of a program for one of several views: without bounces, which are computed for the mean. */
extern const char *const view_outputs[];
/* Do the same for whole estimations. The mean starts as maps of zeros, size × size: */
status view_mean_new(const model_config *config, int size, network_estimation *mean);
void view_mean_add(network_estimation *mean, const network_estimation *turned, int view, float weight);
/* Adds the lights of a photograph, estimated by a model of any light. */
void view_add_lights(float mean[MODEL_LIGHTS], const float turned[MODEL_LIGHTS], int view, float weight);

#endif
