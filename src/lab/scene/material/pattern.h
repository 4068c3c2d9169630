/* SPDX-License-Identifier: MIT */
/* Scalar patterns in the solid space of an object: what colours, borders, roughness and normal detail are made from.
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
    mat3 frame; /* turns and scales the reference: one feature a unit */
    vec3 offset;
    float warp;      /* how far noise bends the space, in units of features */
    float low, high; /* the raw value's range that becomes 0 .. 1, smoothly; close together for a crisp border */
    bool mirrored;   /* alike for x and -x */
    int octaves, centres;
    vec3 centre[PATTERN_CENTRES];
    float sharpness; /* of patches: 2 for ellipsoids, larger for boxes */
    uint32_t seed;
} pattern;

/* At sixteen points; those not wanted may be anything finite and are given anything. facing: normal of the undeformed
 * surface, by which lettering picks the plane it lies in. */
void pattern_values(const pattern *p, const lanes *reference, const lanes *facing, lane_set wanted, float out[LANES]);

/* A random pattern of a kind, with features of about 1/frequency of the object's radius; centres are taken among the
 * mesh's vertices. Its low and high leave the raw value's whole range. */
pattern pattern_random(rng *r, pattern_kind kind, float frequency, const triangle_mesh *mesh, bool mirrored);

/* Sets low and high for two regions with a border of this width (in raw values), the second covering roughly `share`.
 */
void pattern_threshold(pattern *p, float share, float width);

#endif
