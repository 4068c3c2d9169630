/* SPDX-License-Identifier: MIT */
/* Light of bounces 2 and up under another light than the flash.
 *
 *     status s = bounce_follow(&direct_by_flash, &direct, NULL, &indirect);
 *
 * The global-illumination network is taught under the flash, where every visible surface is lit. There it also makes up
 * for what the maps lack, and it goes on doing so where another light leaves its neighbourhood dark: a glow that no
 * bounce explains. Bounces come from lit surfaces nearby, so what the network adds follows the light that these get. */
#ifndef MERLIN_ESTIMATE_LIGHT_BOUNCE_H
#define MERLIN_ESTIMATE_LIGHT_BOUNCE_H

#include "image/image.h"

/* indirect times the share of the flash's light that the new light brings to a pixel's surroundings (a sixteenth of the
 * frame wide), 1 at most. ambient: an environment's light beside it, or NULL. All of one size and 3 channels, bounce 1
 * zero off the object. */
status bounce_follow(const img *direct_by_flash, const img *direct, const img *ambient, img *indirect);

#endif
