/* SPDX-License-Identifier: MIT */
/* The classes of random shapes. Each adds closed surfaces to an empty mesh, in its own space with y up, and says what
 * the later steps should know about it. */
#ifndef MERLIN_LAB_SCENE_SHAPE_SHAPE_H
#define MERLIN_LAB_SCENE_SHAPE_SHAPE_H

#include "base/rng.h"
#include "mesh/mesh.h"

typedef struct shape_traits {
    const char *name;
    bool upright;        /* stands on its -y side, as a vase or a figure does */
    bool mirrored;       /* left and right (x) are alike, so the paint may be, too */
    bool frontal;        /* meant to be seen from +z */
    float crease_cosine; /* edges sharper than this stay edges */
    int parts;
} shape_traits;

void shape_union(rng *r, triangle_mesh *mesh, shape_traits *traits);        /* after Xu et al. 2018 */
void shape_blend(rng *r, triangle_mesh *mesh, shape_traits *traits);        /* smooth implicit bodies and figures */
void shape_revolution(rng *r, triangle_mesh *mesh, shape_traits *traits);   /* vessels, lathed solids, fruit, rings */
void shape_superquadric(rng *r, triangle_mesh *mesh, shape_traits *traits); /* superellipsoids and rounded polyhedra */
void shape_relief(rng *r, triangle_mesh *mesh, shape_traits *traits);       /* plaques, coins, tiles, folded sheets */

/* A uniformly random rotation (Shoemake 1992). */
mat3 random_rotation(rng *r);
/* A uniformly random direction. */
vec3 random_direction(rng *r);
/* Three draws, x first: as arguments of one call their order would be the compiler's choice. */
vec3 random_between(rng *r, float low, float high);
/* Rotation about the axis x, y, z in this order. */
mat3 rotation_xyz(float x, float y, float z);
/* a b */
mat3 mat3_product(const mat3 *a, const mat3 *b);

/* An ellipsoid with these radii about the origin, n x n squares a side. */
void add_ellipsoid(triangle_mesh *mesh, int n, vec3 radii, uint8_t part);

/* Displaces by `amount` at a frequency drawn from [low, high). */
void random_dents(rng *r, triangle_mesh *mesh, uint32_t first, float amount, float low, float high);

/* Bends, twists and tapers positions from vertex `first` on, along y, by random small or large amounts. */
void bend_and_twist(rng *r, triangle_mesh *mesh, uint32_t first);

#endif
