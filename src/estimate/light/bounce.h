/* SPDX-License-Identifier: MIT */
/* Light of bounces 2 and up under a light other than the flash.
 *
 *     status s = bounce_follow(&direct_by_flash, &direct, NULL, &indirect);
 *
 * The global-illumination network is trained with the flash, which lights every visible surface, and there also
 * corrects errors of the maps. It does so, too, where another light leaves the surroundings dark, and adds a glow that
 * no bounce explains. As bounces come from lit surfaces nearby, the network's light is scaled by the light that these
 * receive. */
#ifndef MERLIN_ESTIMATE_LIGHT_BOUNCE_H
#define MERLIN_ESTIMATE_LIGHT_BOUNCE_H

#include "image/image.h"

/* Multiplies indirect by the light that reaches a pixel's surroundings (a sixteenth of the frame wide), relative to the
 * flash's there, at most 1. ambient: additional light of an environment, or NULL. All have one size and 3 channels;
 * bounce 1 is zero outside the object. */
status bounce_follow(const img *direct_by_flash, const img *direct, const img *ambient, img *indirect);

#endif
