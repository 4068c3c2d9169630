/* SPDX-License-Identifier: MIT */
/* Solids from which procedural shapes are made: grids wrapped onto a cube's image, lathed profiles, tubes.
 *
 *     lathe_profile p = {0};
 *     lathe_profile_add(&p, 0, -1);
 *     lathe_profile_add(&p, 0.5f, 0);
 *     lathe_profile_add(&p, 0, 1);
 *     mesh_add_lathe(&mesh, &p, 96, part);
 */
#ifndef MERLIN_LAB_SCENE_SHAPE_MESH_SOLIDS_H
#define MERLIN_LAB_SCENE_SHAPE_MESH_SOLIDS_H

#include "mesh/mesh.h"

/* Adds the cube [-1, 1]^3 with n x n squares a face, each vertex mapped by `map`, which must preserve orientation. */
void mesh_add_cube_grid(triangle_mesh *mesh, int n, uint8_t part, vec3 (*map)(const void *context, vec3 cube),
                        const void *context);

/* A profile in the half plane (radius, height): from the axis at the bottom, up the outside, back to the axis. */
enum { PROFILE_POINTS = 256 };
typedef struct lathe_profile {
    int count;
    bool closed; /* a loop that does not touch the axis: a ring */
    float radius[PROFILE_POINTS], height[PROFILE_POINTS];
} lathe_profile;

void lathe_profile_add(lathe_profile *p, float radius, float height);
/* Adds the corner of the path from -> corner -> to, rounded by a curve that leaves it `round` before. */
void lathe_profile_add_corner(lathe_profile *p, const float from[2], const float corner[2], const float to[2],
                              float round, int steps);
/* Adds the surface of the profile revolved about the y axis. */
void mesh_add_lathe(triangle_mesh *mesh, const lathe_profile *p, int segments, uint8_t part);

/* Adds a tube along the polyline path, as wide as radius says at each point, flattened by aspect; its ends are closed.
 */
void mesh_add_tube(triangle_mesh *mesh, const vec3 *path, const float *radius, int count, int segments, float aspect,
                   uint8_t part);

#endif
