/* SPDX-License-Identifier: MIT */
/* The light that a model of any light sees in a photograph, and a surface under it.
 *
 *     found_light_take(estimation.lights, &maps.light);
 *     status s = found_light_add(&full, &maps.light, &visibility, &picture);      picture += that light's part
 *     s = found_light_stand(&maps.light, 90, &lights);                            turned, to relight maps by
 */
#ifndef MERLIN_ESTIMATE_LIGHT_FOUND_LIGHT_H
#define MERLIN_ESTIMATE_LIGHT_FOUND_LIGHT_H

#include "base/api_needs.h"
#include "estimate/light/env_map.h"
#include "estimate/surface/surface.h"
#include "merlin/merlin.h"
#include "model/model.h"

/* Takes the light from the network's code (model.h, MODEL_LIGHTS). A lamp that it is less than half sure of is none. */
void found_light_take(const float code[MODEL_LIGHTS], merlin_found_light *out);

/* Shares of all light that arrives in the object's middle, in the mean of the channels: the lamp's wherever that
 * stands, and of the rest what reaches a surface that faces the camera. They add up to 1; zeros: nothing is known. */
typedef struct found_light_shares {
    float flash, lamp, rest;
} found_light_shares;
found_light_shares found_light_share(const merlin_found_light *light);
/* Tells whether the flash's share is so large that what else there is may be a mistake. */
bool found_light_is_flash(const merlin_found_light *light);

/* Makes the lamp as relighting has it, its tint the strength by channel; false where there is none. */
bool found_light_lamp(const merlin_found_light *light, lamp *out);

/* The found light as relighting takes it. */
typedef struct found_lights {
    lamp lamps[2]; /* the flash and the lamp, as far as there are any */
    int count;     /* of lamps */
    int fixed;     /* those before this one, the flash, do not turn */
    env_map rest;  /* surroundings of everything else's radiance; found_lights_rest tells whether there are any */
} found_lights;
/* Makes them of what was found, turned by so many degrees. MERLIN_BAD_INPUT where nothing is known or all is dark;
 * MERLIN_NO_MEMORY. rest is to be freed by env_map_free. */
status found_light_stand(const merlin_found_light *light, float turn, found_lights *out);
/* Returns the surroundings, NULL where they are dark. */
const env_map *found_lights_rest(const found_lights *l);
/* Turns all but the flash further about the vertical as env_map_turn does it, the lamp about the object's middle. */
void found_lights_turn(found_lights *l, float degrees);

/* Adds flash, lamp and the rest to out (3 channels, the surface's size). visibility: 1 channel, of any size, of the
 * lamp; without data it reaches all that faces it. MERLIN_NO_MEMORY. */
status found_light_add(const surface *s, const merlin_found_light *light, const img *visibility, img *out);

#endif
