/* SPDX-License-Identifier: MIT */
/* An environment to be reflected: a latitude-longitude map prepared for blurred lookups.
 *
 *     env_map env;
 *     status s = env_map_new(&latlong, &env);
 *     env_map_turn(&env, 90);                            what was straight ahead is now to the right
 *     vec3 radiance = env_map_lookup(&env, d, 0.01f);    mean over about 0.01 steradians around d
 *     vec3 irradiance = sh_irradiance(env.sh, n);
 *     env_map_free(&env);
 *
 * The radiance is stored on an octahedron unfolded into a square on which every texel has the same solid angle
 * (Clarberg 2008), at all resolutions: it has no poles, and a mean over 2×2 texels is a mean over solid angle. */
#ifndef MERLIN_ESTIMATE_LIGHT_ENV_MAP_H
#define MERLIN_ESTIMATE_LIGHT_ENV_MAP_H

#include "base/vec.h"
#include "image/image.h"

enum { ENV_MAP_LEVELS = 9, ENV_MAP_SIDE = 1 << ENV_MAP_LEVELS };

typedef struct env_map {
    img levels[ENV_MAP_LEVELS]; /* sides 512, 256, ... 2 */
    float sh[9][3];             /* coefficients of radiance (optics/sh.h), turned */
    float cosine, sine;         /* cosine and sine of the turn */
} env_map;

/* Makes the map. latlong: 3 channels, radiance, as in optics/latlong.h. Values that are negative or not finite are set
 * to black in latlong itself, as maps may have gigabytes and are not copied. */
status env_map_new(img *latlong, env_map *out);
void env_map_free(env_map *e);

/* Turns the environment further about the vertical, clockwise seen from above: ahead to the right, right to behind the
 * camera. */
void env_map_turn(env_map *e, float degrees);
/* Multiplies all radiance. */
void env_map_scale(env_map *e, float factor);
/* Returns the mean luminance over the sphere. */
float env_map_mean(const env_map *e);

/* Returns the radiance from around the unit direction d, averaged over about this solid angle in steradians; 0: at the
 * map's full resolution. */
vec3 env_map_lookup(const env_map *e, vec3 d, float solid_angle);

#endif
