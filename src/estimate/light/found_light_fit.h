/* SPDX-License-Identifier: MIT */
/* The light that a model of any light tells of a photograph, fitted to the photograph by the model's own maps.
 *
 *     status s = found_light_fit(&(lit_photo){&maps, &photo, &visibility, gain}, estimation.lights);
 *
 * The network tells to which side of the lens a lamp is, but not how far aside: too far by some 20 degrees, as most
 * lamps of its training were far aside. Its maps hardly depend on that, and explain the photograph best under the true
 * light (docs/notes/any_light.md). */
#ifndef MERLIN_ESTIMATE_LIGHT_FOUND_LIGHT_FIT_H
#define MERLIN_ESTIMATE_LIGHT_FOUND_LIGHT_FIT_H

#include "estimate/surface/surface.h"
#include "model/model.h"

typedef struct lit_photo {
    const surface *maps;   /* square */
    const img *photo;      /* 3 channels, radiance, of the maps' size */
    const img *visibility; /* 1 channel, of the lamp, of the maps' size; without data it is not hidden */
    float white;           /* radiance at which the photograph saturates */
} lit_photo;

/* Fits the lamp's direction and distance, unless it is more than 70 degrees aside, and the strengths of lamp, flash and
 * the rest; the network's confidence in the lamp stays. Without a lamp that found_light_take keeps, all light is scaled
 * by one number a channel; a room's coefficients, if most of it is that, are fitted, too. Nothing changes if too little
 * of the object is seen, or if the photograph is explained best without the lamp. MERLIN_NO_MEMORY. */
status found_light_fit(const lit_photo *of, float code[MODEL_LIGHTS]);

#endif
