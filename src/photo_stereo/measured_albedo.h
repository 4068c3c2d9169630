/* SPDX-License-Identifier: MIT */
/* The albedo that photometric stereo measures, in place of a network's, which guesses it from each pixel's brightness.
 *
 *     measured_albedo_take(&surface.albedo, &maps);
 */
#ifndef MERLIN_PHOTO_STEREO_MEASURED_ALBEDO_H
#define MERLIN_PHOTO_STEREO_MEASURED_ALBEDO_H

#include "merlin/maps.h"

/* Replaces the maps' albedo where it was measured. measured: 1 or 3 channels, of the maps' size, 0 where it is unknown.
 * The lights' strength and colour are unknown and with them its scale, in each channel: it becomes that with which it
 * differs least from the present albedo. One channel alone gives the brightness, and the colour stays. */
void measured_albedo_take(const merlin_image *measured, merlin_maps *maps);

#endif
