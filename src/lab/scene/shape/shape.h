/* SPDX-License-Identifier: MIT */
/* Classes of random shapes. Each adds closed surfaces to an empty mesh, in its own space with y up, and reports
 * properties that later steps need. */
#ifndef MERLIN_LAB_SCENE_SHAPE_SHAPE_H
#define MERLIN_LAB_SCENE_SHAPE_SHAPE_H

#include "base/rng.h"
#include "mesh/mesh.h"

typedef struct shape_traits {
    const char *name;
    bool upright;        /* stands on its -y side, as a vase or a figure does */
    bool mirrored;       /* symmetric in x, so that the paint may be symmetric, too */
    bool frontal;        /* designed to be seen from +z */
    float crease_cosine; /* edges sharper than this stay edges */
    int parts;
} shape_traits;

void shape_union(rng *r, triangle_mesh *mesh, shape_traits *traits);        /* after Xu et al. 2018 */
void shape_blend(rng *r, triangle_mesh *mesh, shape_traits *traits);        /* smooth implicit bodies and figures */
void shape_revolution(rng *r, triangle_mesh *mesh, shape_traits *traits);   /* vessels, lathed solids, fruit, rings */
void shape_superquadric(rng *r, triangle_mesh *mesh, shape_traits *traits); /* superellipsoids and rounded polyhedra */
void shape_relief(rng *r, triangle_mesh *mesh, shape_traits *traits);       /* plaques, coins, tiles, folded sheets */

/* Returns a uniformly random rotation (Shoemake 1992). */
mat3 random_rotation(rng *r);
/* Returns a uniformly random direction. */
vec3 random_direction(rng *r);
/* Returns three random numbers as a vector, x first: in a single call the order of evaluation would be unspecified. */
vec3 random_between(rng *r, float low, float high);
/* Returns the rotation about the axes x, y, z in this order. */
mat3 rotation_xyz(float x, float y, float z);
/* Returns a b. */
mat3 mat3_product(const mat3 *a, const mat3 *b);

/* Adds an ellipsoid with these radii about the origin, n x n squares a side. */
void add_ellipsoid(triangle_mesh *mesh, int n, vec3 radii, uint8_t part);

/* Displaces by `amount` at a random frequency in [low, high). */
void random_dents(rng *r, triangle_mesh *mesh, uint32_t first, float amount, float low, float high);

/* Bends, twists and tapers positions from vertex `first` on, along y, by random small or large amounts. */
void bend_and_twist(rng *r, triangle_mesh *mesh, uint32_t first);

#endif
