/* SPDX-License-Identifier: MIT */
/* Scalar patterns in an object's solid space, from which colours, borders, roughness and normal detail are made.
 *
 *     pattern_values(&pattern, &reference, &facing, lanes_first(count), share);      // in [0, 1]
 */
#ifndef MERLIN_LAB_SCENE_MATERIAL_PATTERN_H
#define MERLIN_LAB_SCENE_MATERIAL_PATTERN_H

#include "base/lanes.h"
#include "base/rng.h"
#include "mesh/mesh.h"

typedef enum pattern_kind {
    PATTERN_FBM,
    PATTERN_TURBULENCE,
    PATTERN_CELLS,       /* distance to the nearest feature point */
    PATTERN_CELL_EDGES,  /* low along the borders of cells */
    PATTERN_CELL_VALUES, /* one random value a cell */
    PATTERN_STRIPES,
    PATTERN_RINGS, /* wood: cylinders around an axis */
    PATTERN_MARBLE,
    PATTERN_SPOTS,
    PATTERN_CHECKS,
    PATTERN_SCRATCHES,
    PATTERN_LETTERS,
    PATTERN_BANDS,    /* random values in layers along y */
    PATTERN_PATCHES,  /* high near chosen centres */
    PATTERN_GRADIENT, /* along y */
} pattern_kind;

enum { PATTERN_CENTRES = 6 };

typedef struct pattern {
    pattern_kind kind;
    mat3 frame; /* rotates and scales the reference: one feature a unit */
    vec3 offset;
    float warp;      /* amplitude of noise added to the position, in units of features */
    float low, high; /* range of raw values mapped smoothly to 0 .. 1; narrow for a sharp border */
    bool mirrored;   /* symmetric in x */
    int octaves, centres;
    vec3 centre[PATTERN_CENTRES];
    float sharpness; /* of patches: 2 for ellipsoids, larger for boxes */
    uint32_t seed;
} pattern;

/* Evaluates a pattern at sixteen points; those not wanted may hold any finite position and get any value. facing:
 * normal of the undeformed surface, by which lettering chooses its plane. */
void pattern_values(const pattern *p, const lanes *reference, const lanes *facing, lane_set wanted, float out[LANES]);

/* Returns a random pattern of a kind, with features of about 1/frequency of the object's radius; centres are vertices
 * of the mesh. low and high span the whole range of raw values. */
pattern pattern_random(rng *r, pattern_kind kind, float frequency, const triangle_mesh *mesh, bool mirrored);

/* Sets low and high for two regions with a border of this width (in raw values), the second covering roughly `share`.
 */
void pattern_threshold(pattern *p, float share, float width);

#endif
