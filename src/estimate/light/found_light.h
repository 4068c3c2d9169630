/* SPDX-License-Identifier: MIT */
/* The light that a model of any light estimates from a photograph, and a surface lit by it.
 *
 *     found_light_take(estimation.lights, &maps.light);
 *     status s = found_light_add(&full, &maps.light, &visibility, &picture);      picture += light reflected
 *     s = found_light_stand(&maps.light, 90, &lights);                            the same light turned, to relight
 * maps
 */
#ifndef MERLIN_ESTIMATE_LIGHT_FOUND_LIGHT_H
#define MERLIN_ESTIMATE_LIGHT_FOUND_LIGHT_H

#include "base/api_needs.h"
#include "estimate/light/env_map.h"
#include "estimate/surface/surface.h"
#include "merlin/merlin.h"
#include "model/model.h"

/* Decodes the light from the network's output (model.h, MODEL_LIGHTS). A lamp with a probability below one half is
 * dropped. */
void found_light_take(const float code[MODEL_LIGHTS], merlin_found_light *out);
/* Tells whether found_light_take keeps the lamp. */
bool found_light_has_lamp(const float code[MODEL_LIGHTS]);
/* Returns a lamp's distance from the object's middle by its inverse; 0: so far that its light is parallel. */
float found_light_distance(float inverse);
/* Returns the mean over the channels. */
static inline float found_light_mean(vec3 v)
{
    return (v.x + v.y + v.z) / 3;
}

/* Shares of all light that arrives in the object's middle, averaged over the channels: the lamp's wherever it is, and
 * of the rest what reaches a surface that faces the camera. They add up to 1; all zero if nothing is known. */
typedef struct found_light_shares {
    float flash, lamp, rest;
} found_light_shares;
found_light_shares found_light_share(const merlin_found_light *light);
/* Tells whether the flash's share is so large that the estimate of other light may be an error. */
bool found_light_is_flash(const merlin_found_light *light);

/* Makes the lamp for relighting, with the strength by channel as its tint; returns false if there is none. */
bool found_light_lamp(const merlin_found_light *light, lamp *out);

/* The estimated light in the form that relighting uses. */
typedef struct found_lights {
    lamp lamps[2]; /* the flash and the lamp, if there are any */
    int count;     /* number of lamps */
    int fixed;     /* number of lamps that do not turn: the flash */
    env_map rest;  /* environment of all other radiance; found_lights_rest tells whether there is any */
} found_lights;
/* Makes the lights, turned by so many degrees. MERLIN_BAD_INPUT if nothing is known or all is dark; MERLIN_NO_MEMORY.
 * Free rest with env_map_free. */
status found_light_stand(const merlin_found_light *light, float turn, found_lights *out);
/* Returns the environment, or NULL if it is dark. */
const env_map *found_lights_rest(const found_lights *l);
/* Turns all but the flash further about the vertical, as env_map_turn does; the lamp turns about the object's middle.
 */
void found_lights_turn(found_lights *l, float degrees);

/* Adds the light of flash, lamp and environment to out (3 channels, the surface's size). visibility: of the lamp, 1
 * channel, any size; without data the lamp reaches everything that faces it. MERLIN_NO_MEMORY. */
status found_light_add(const surface *s, const merlin_found_light *light, const img *visibility, img *out);

#endif
