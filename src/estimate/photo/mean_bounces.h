/* SPDX-License-Identifier: MIT */
/* Bounces 2 and up of a photograph, for the mean maps of several views.
 *
 *     status s = network_estimate(n, &photo, &mask, &how, 4, NULL, &mean);
 *     if (s == OK) s = mean_bounces(n, &mean, &mean.indirect);
 *
 * The network's bounces also compensate false highlights of the maps of the same view; the mean maps have others. */
#ifndef MERLIN_ESTIMATE_PHOTO_MEAN_BOUNCES_H
#define MERLIN_ESTIMATE_PHOTO_MEAN_BOUNCES_H

#include "estimate/photo/network.h"

/* Runs the network for bounces under the photograph's own flash, and its environment if the model estimates one. */
status mean_bounces(network *n, const network_estimation *mean, img *indirect);

#endif
