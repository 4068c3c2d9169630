/* SPDX-License-Identifier: MIT */
/* Environment light: a latitude-longitude map of linear radiance, procedural or from a file, with importance sampling.
 *
 *     environment env;
 *     status s = environment_procedural(&generator, &env);
 *     vec3 l, radiance = environment_sample(&env, u1, u2, &l, &pdf);
 *     environment_free(&env);
 *
 * Directions as in optics/latlong.h. */
#ifndef MERLIN_LAB_RENDER_ENVIRONMENT_H
#define MERLIN_LAB_RENDER_ENVIRONMENT_H

#include "base/lanes.h"
#include "base/rng.h"
#include "base/skipped.h"
#include "image/image.h"

/* Size of procedural maps, and of maps from files after shrinking. */
enum { ENVIRONMENT_WIDTH = 256, ENVIRONMENT_HEIGHT = 128 };

typedef struct environment {
    img map;        /* 3 channels */
    float *rows;    /* height + 1: cumulative probability of rows */
    float *cosines; /* height + 1: cosine of the polar angle at the rows' borders */
    float *columns; /* height × (width + 1): cumulative probability within a row */
    float sh[9][3]; /* radiance coefficients */
    bool tents; /* texels are sampled over the width of their interpolation kernel; else uniformly inside their borders
                 */
} environment;

/* Generates a random sky, room or studio, with the mean radiance of usual exposures. */
status environment_procedural(rng *r, environment *out);
/* Takes a map that was read, rotated about the vertical and exposed at random. */
status environment_from_map(const img *map, rng *r, environment *out);
void environment_free(environment *env);

/* Returns the interpolated radiance from the unit direction d, and the density of environment_sample there, 1/sr. */
vec3 environment_look(const environment *env, vec3 d, real *pdf);
/* Directions, and the radiance from there, one a lane. */
typedef struct environment_rays {
    lanes direction, radiance;
    float pdf[LANES];
} environment_rays;

/* Samples `count` directions with a density about proportional to the map's brightness. */
void environment_sample(const environment *env, const float u1[LANES], const float u2[LANES], int count,
                        environment_rays *out);

/* All pictures of a folder, recognized by content, shrunk to the size that lighting needs. */
typedef struct environment_folder {
    img *maps;
    size_t count;
    skipped_files skipped;
} environment_folder;
status environment_folder_read(const char *path, environment_folder *out);
void environment_folder_free(environment_folder *folder);

#endif
