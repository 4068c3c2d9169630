/* SPDX-License-Identifier: MIT */
/* Triangle meshes that grow a vertex or a face at a time.
 *
 *     triangle_mesh mesh = {0};
 *     uint32_t a = mesh_add_vertex(&mesh, p), b = mesh_add_vertex(&mesh, q), c = mesh_add_vertex(&mesh, r);
 *     mesh_add_triangle(&mesh, a, b, c, part);
 *     status s = mesh_finish(&mesh, crease);      reports what went wrong in any call before
 *     mesh_free(&mesh);
 *
 * Adding never fails by itself: when memory runs out the mesh records it, and mesh_finish returns the error. */
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

typedef struct triangle_mesh {
    uint32_t vertex_count, vertex_capacity, triangle_count, triangle_capacity;
    vec3 *position, *reference;
    vec3 *normal; /* NULL until known */
    uint32_t (*triangle)[3];
    uint8_t *part;
    bool failed; /* memory ran out */
} triangle_mesh;

void mesh_free(triangle_mesh *mesh);
void mesh_copy(const triangle_mesh *mesh, triangle_mesh *out);
uint32_t mesh_add_vertex(triangle_mesh *mesh, vec3 position); /* its reference is its position */
void mesh_add_triangle(triangle_mesh *mesh, uint32_t a, uint32_t b, uint32_t c, uint8_t part);
void mesh_add_quad(triangle_mesh *mesh, uint32_t a, uint32_t b, uint32_t c, uint32_t d, uint8_t part);
/* Any polygon, concave ones too. corner is used up. */
void mesh_add_polygon(triangle_mesh *mesh, uint32_t *corner, int count, uint8_t part);

/* Applies p = linear p + offset to positions (and references too if asked) from vertex `first` on. */
void mesh_transform(triangle_mesh *mesh, uint32_t first, const mat3 *linear, vec3 offset, bool references);

/* Centres positions and scales them to a largest distance of 1; references alike when they follow. */
void mesh_normalize(triangle_mesh *mesh);

/* Area-weighted smooth normals of all vertices into normal[vertex_count]. */
void mesh_smooth_normals(const triangle_mesh *mesh, vec3 *normal);

/* Six times the enclosed volume, positive when triangles wind counter-clockwise from outside. */
double mesh_signed_volume(const triangle_mesh *mesh);

/* For meshes from files: drops vertices that no triangle uses and, where normals are not known, makes those of exactly
 * one place one, whatever else (texture coordinates, materials) told them apart in the file. */
void mesh_weld(triangle_mesh *mesh);
/* Drops triangles that lie exactly where one before does and face its way, if half of all do or more: each ray there
 * asks all of them. A few do no harm, and modellers leave some. */
void mesh_drop_repeated(triangle_mesh *mesh);

/* Drops triangles without area and unused vertices; gives vertices normals (unless they have them), splitting those at
 * edges where faces meet at more than the angle whose cosine is given. MERLIN_NO_MEMORY; MERLIN_BAD_INPUT when no
 * triangle is left. */
status mesh_finish(triangle_mesh *mesh, float crease_cosine);

#endif
