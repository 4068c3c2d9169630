/* SPDX-License-Identifier: MIT */
/* Procedural environments: skies with sun and clouds, rooms with windows and lamps, studios with soft boxes. */
#ifndef MERLIN_LAB_RENDER_SKY_H
#define MERLIN_LAB_RENDER_SKY_H

#include "base/rng.h"
#include "image/image.h"

/* Fills a 3-channel latitude-longitude map (render/environment.h) with a random one, in arbitrary units. */
void sky_fill(img *map, rng *r);

#endif
