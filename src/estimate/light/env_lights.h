/* SPDX-License-Identifier: MIT */
/* An environment as a few distant lights, more of them where it is bright, to cast shadows.
 *
 *     env_light lights[ENV_LIGHTS_MOST];
 *     int count = env_lights(&env, lights);
 *
 * The sphere is halved repeatedly, each part where its light is halved (P. Debevec, A median cut algorithm for light
 * probe sampling, SIGGRAPH 2005 posters). The weight is half light, half solid angle, so that a lamp does not leave
 * only a few lights for the rest of a room. */
#ifndef MERLIN_ESTIMATE_LIGHT_ENV_LIGHTS_H
#define MERLIN_ESTIMATE_LIGHT_ENV_LIGHTS_H

#include "estimate/light/env_map.h"

enum { ENV_LIGHTS_MOST = 256 };

typedef struct env_light {
    vec3 direction;    /* unit vector toward it, turned as the map is */
    vec3 power;        /* radiance times solid angle of the whole part */
    float solid_angle; /* solid angle of its part of the sphere */
} env_light;

/* Finds the lights and returns their number, which is less than ENV_LIGHTS_MOST if nearly all light comes from one
 * point. */
int env_lights(const env_map *e, env_light lights[ENV_LIGHTS_MOST]);

#endif
