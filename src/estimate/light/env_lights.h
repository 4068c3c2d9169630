/* SPDX-License-Identifier: MIT */
/* Surroundings as a few distant lights, many where they are bright: what shadows are cast by.
 *
 *     env_light lights[ENV_LIGHTS_MOST];
 *     int count = env_lights(&env, lights);
 *
 * The sphere is halved again and again, each part where its light is halved (P. Debevec, A median cut algorithm for
 * light probe sampling, SIGGRAPH 2005 posters). Half of what counts is the light, the other half the solid angle, so
 * that a lamp does not leave the rest of a room to a handful of lights. */
#ifndef MERLIN_ESTIMATE_LIGHT_ENV_LIGHTS_H
#define MERLIN_ESTIMATE_LIGHT_ENV_LIGHTS_H

#include "estimate/light/env_map.h"

enum { ENV_LIGHTS_MOST = 256 };

typedef struct env_light {
    vec3 direction;    /* unit, toward it, turned as the map is */
    vec3 power;        /* radiance times solid angle, whole */
    float solid_angle; /* of its part of the sphere */
} env_light;

/* How many there are: fewer than ENV_LIGHTS_MOST where nearly all comes from one point. */
int env_lights(const env_map *e, env_light lights[ENV_LIGHTS_MOST]);

#endif
