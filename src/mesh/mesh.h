/* SPDX-License-Identifier: MIT */
/* A triangle mesh that grows, and what shapes are made of: grids wrapped onto solids, lathed profiles, tubes.
 *
 *     scn_mesh mesh = {0};
 *     mesh_add_lathe(&mesh, &profile, 96, part);
 *     mesh_displace(&mesh, 0, 0.05f, 2.0f, seed);
 *     status s = mesh_finish(&mesh, crease);      // reports what went wrong in any call before
 *     mesh_free(&mesh);
 *
 * Adding never fails by itself: when memory runs out the mesh remembers it, and mesh_finish says so. */
#ifndef MERLIN_MESH_MESH_H
#define MERLIN_MESH_MESH_H

#include <stdbool.h>
#include <stdint.h>

#include "base/status.h"
#include "base/vec.h"

typedef struct mat3 {
    vec3 row[3];
} mat3;

static inline vec3 mat3_apply(const mat3 *m, vec3 v)
{
    return vec3_make(vec3_dot(m->row[0], v), vec3_dot(m->row[1], v), vec3_dot(m->row[2], v));
}

/* The transpose applied, the inverse of a rotation. */
static inline vec3 mat3_apply_transposed(const mat3 *m, vec3 v)
{
    return vec3_fma(vec3_fma(vec3_scale(m->row[0], v.x), v.y, m->row[1]), v.z, m->row[2]);
}

enum { MESH_PARTS = 32 }; /* parts of a mesh are below it */

typedef struct scn_mesh {
    uint32_t vertex_count, vertex_capacity, triangle_count, triangle_capacity;
    vec3 *position, *reference;
    vec3 *normal; /* NULL until known */
    uint32_t (*triangle)[3];
    uint8_t *part;
    bool failed; /* memory ran out */
} scn_mesh;

void mesh_free(scn_mesh *mesh);
void mesh_copy(const scn_mesh *mesh, scn_mesh *out);
uint32_t mesh_add_vertex(scn_mesh *mesh, vec3 position); /* its reference is its position */
void mesh_add_triangle(scn_mesh *mesh, uint32_t a, uint32_t b, uint32_t c, uint8_t part);
void mesh_add_quad(scn_mesh *mesh, uint32_t a, uint32_t b, uint32_t c, uint32_t d, uint8_t part);
/* Any polygon, concave ones too. corner is used up. */
void mesh_add_polygon(scn_mesh *mesh, uint32_t *corner, int count, uint8_t part);

/* The cube [-1, 1]^3 with n x n squares a face, each vertex put where map sends it; map keeps the orientation. */
void mesh_add_cube_grid(scn_mesh *mesh, int n, uint8_t part, vec3 (*map)(const void *context, vec3 cube),
                        const void *context);

/* A profile in the half plane (radius, height): from the axis at the bottom, up the outside, back to the axis. */
enum { PROFILE_POINTS = 256 };
typedef struct profile {
    int count;
    bool closed; /* a loop that never touches the axis: a ring */
    float radius[PROFILE_POINTS], height[PROFILE_POINTS];
} profile;

void profile_add(profile *p, float radius, float height);
/* Adds the corner of the way from -> corner -> to, rounded by a curve that leaves it `round` before. */
void profile_add_corner(profile *p, const float from[2], const float corner[2], const float to[2], float round,
                        int steps);
/* Turns the profile about the y axis. */
void mesh_add_lathe(scn_mesh *mesh, const profile *p, int segments, uint8_t part);

/* A tube around the polyline path, as wide as radius says at each point, flattened by aspect; its ends are closed. */
void mesh_add_tube(scn_mesh *mesh, const vec3 *path, const float *radius, int count, int segments, float aspect,
                   uint8_t part);

/* Applies p = linear p + offset to positions (and references too if asked) from vertex `first` on. */
void mesh_transform(scn_mesh *mesh, uint32_t first, const mat3 *linear, vec3 offset, bool references);

/* Centres positions and scales them to a largest distance of 1; references alike when they follow. */
void mesh_normalize(scn_mesh *mesh);

/* Area-weighted smooth normals of all vertices into normal[vertex_count]. */
void mesh_smooth_normals(const scn_mesh *mesh, vec3 *normal);

/* Six times the enclosed volume, positive when triangles wind counter-clockwise from outside. */
double mesh_signed_volume(const scn_mesh *mesh);

/* For meshes from files: drops vertices that no triangle uses and, where normals are not known, makes those of exactly
 * one place one, whatever else (texture coordinates, materials) told them apart in the file. */
void mesh_weld(scn_mesh *mesh);
/* Drops triangles that lie exactly where one before does and face its way, if half of all do or more: each ray there
 * asks all of them. A few do no harm, and modellers leave some. */
void mesh_drop_repeated(scn_mesh *mesh);

/* Drops triangles without area and unused vertices; gives vertices normals (unless they have them), splitting those at
 * edges where faces meet at more than the angle whose cosine is given. MERLIN_NO_MEMORY; MERLIN_BAD_INPUT when no
 * triangle is left. */
status mesh_finish(scn_mesh *mesh, float crease_cosine);

#endif
