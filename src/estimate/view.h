/* A photograph seen by the network in several orientations, and the mean of what it says of them.
 *
 *     view_mean_new(size, &mean);
 *     for (int view = 0; view < views; view++) {
 *         view_put(program, 0, view, &photo, &mask);
 *         ... nn_forward, and an estimation out of its outputs ...
 *         view_mean_add(&mean, &estimation, view, 1.0f / views);
 *     }
 *
 * The network was trained on all eight and errs differently in each. */
#ifndef MERLIN_ESTIMATE_VIEW_H
#define MERLIN_ESTIMATE_VIEW_H

#include "estimate/network.h"

/* Into picture `slot` of the inputs of a program of MODEL_WHOLE, both before every run, which may overwrite them: a
 * square photograph and its mask in this orientation (optics/orientation.h), and a light as it stands to the turned
 * photograph: the target, or for maps the flash. A model of setting A leaves surroundings out. */
void view_put(nn_program *p, size_t slot, int view, const img *photo, const img *mask);
void view_put_light(nn_program *p, const model_config *config, size_t slot, int view, const illumination *light);

/* Adds weight times an image of the turned frame, turned back; of unit normals, whose sum is not unit. */
void view_add(img *mean, const img *turned, int view, float weight);
void view_add_normals(img *mean, const img *turned, int view, float weight);

/* What a program that looks at one of several views is made for (nn_options): not bounces, which are the mean's own. */
extern const char *const view_outputs[];
/* The same for all of these. Zero maps of size × size: */
status view_mean_new(int size, network_estimation *mean);
void view_mean_add(network_estimation *mean, const network_estimation *turned, int view, float weight);

#endif
