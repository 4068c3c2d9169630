/* A photograph seen by the network in several orientations, and the mean of what it says of them.
 *
 *     view_mean_new(size, &mean);
 *     for (int view = 0; view < views; view++) {
 *         view_turn(&photo, view, &turned);
 *         ... an estimation of it ...
 *         view_mean_add(&mean, &estimation, view, 1.0f / views);
 *     }
 *
 * The network was trained on all eight and errs differently in each. */
#ifndef MERLIN_ESTIMATE_VIEW_H
#define MERLIN_ESTIMATE_VIEW_H

#include "estimate/network.h"

/* A square image in this orientation (optics/orientation.h); made here. */
status view_turn(const img *image, int view, img *turned);

/* A light as it stands to the turned photograph; its environment, if any, is kept in sh. */
network_light view_turn_light(const network_light *light, int view, float sh[9][3]);

/* Adds weight times an image of the turned frame, turned back; of unit normals, whose sum is not unit. */
void view_add(img *mean, const img *turned, int view, float weight);
void view_add_normals(img *mean, const img *turned, int view, float weight);

/* The same for all that the network says. Zero maps of size × size, without mask: */
status view_mean_new(int size, network_estimation *mean);
void view_mean_add(network_estimation *mean, const network_estimation *turned, int view, float weight);

#endif
