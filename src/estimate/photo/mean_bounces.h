/* SPDX-License-Identifier: MIT */
/* Bounces 2 and up of a photograph that several views' mean maps explain.
 *
 *     status s = network_estimate(n, &photo, &mask, &how, 4, NULL, &mean);
 *     if (s == OK) s = mean_bounces(n, &mean, &mean.indirect);
 *
 * What the network adds makes up for the false highlights of its own maps, view by view; those of the mean are others.
 */
#ifndef MERLIN_ESTIMATE_PHOTO_MEAN_BOUNCES_H
#define MERLIN_ESTIMATE_PHOTO_MEAN_BOUNCES_H

#include "estimate/photo/network.h"

/* Asks the network for them, under the photograph's own flash, and its environment where the model knows one. */
status mean_bounces(network *n, const network_estimation *mean, img *indirect);

#endif
