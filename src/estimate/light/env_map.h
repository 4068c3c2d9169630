/* SPDX-License-Identifier: MIT */
/* Surroundings to be reflected: a latitude-longitude map made ready for blurred look-ups.
 *
 *     env_map env;
 *     status s = env_map_new(&latlong, &env);
 *     env_map_turn(&env, 90);                            what was straight ahead is to the right now
 *     vec3 radiance = env_map_lookup(&env, d, 0.01f);    mean over about 0.01 steradians around d
 *     vec3 irradiance = sh_irradiance(env.sh, n);
 *     env_map_free(&env);
 *
 * The radiance is kept on an octahedron unfolded into a square on which every texel is the same solid angle (Clarberg
 * 2008), with all its halvings: no poles, and a mean over 2×2 texels is a mean over solid angle. */
#ifndef MERLIN_ESTIMATE_LIGHT_ENV_MAP_H
#define MERLIN_ESTIMATE_LIGHT_ENV_MAP_H

#include "base/vec.h"
#include "image/image.h"

enum { ENV_MAP_LEVELS = 9, ENV_MAP_SIDE = 1 << ENV_MAP_LEVELS };

typedef struct env_map {
    img levels[ENV_MAP_LEVELS]; /* sides 512, 256, ... 2 */
    float sh[9][3];             /* radiance coefficients (optics/sh.h), turned */
    float cosine, sine;         /* of the turn */
} env_map;

/* latlong: 3 channels, radiance, as in optics/latlong.h; what is not finite or negative becomes black there, too: of
 * the largest maps, of gigabytes, no second one is made. */
status env_map_new(img *latlong, env_map *out);
void env_map_free(env_map *e);

/* Turns it further about the vertical, seen from above clockwise: ahead to the right, right to behind the camera. */
void env_map_turn(env_map *e, float degrees);
/* Multiplies all radiance. */
void env_map_scale(env_map *e, float factor);
/* Mean luminance over the sphere. */
float env_map_mean(const env_map *e);

/* Radiance from about the unit direction d, averaged over about so many steradians; 0: as sharp as the map is. */
vec3 env_map_lookup(const env_map *e, vec3 d, float solid_angle);

#endif
