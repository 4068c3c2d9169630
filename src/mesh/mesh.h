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

/* Applies the transpose, which is the inverse of a rotation. */
static inline vec3 mat3_apply_transposed(const mat3 *m, vec3 v)
{
    return vec3_fma(vec3_fma(vec3_scale(m->row[0], v.x), v.y, m->row[1]), v.z, m->row[2]);
}

enum { MESH_PARTS = 32 }; /* part numbers are below it */

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
/* Adds any polygon, concave ones too. corner is overwritten. */
void mesh_add_polygon(triangle_mesh *mesh, uint32_t *corner, int count, uint8_t part);

/* Applies p = linear p + offset to positions (and to references if asked) from vertex `first` on. */
void mesh_transform(triangle_mesh *mesh, uint32_t first, const mat3 *linear, vec3 offset, bool references);

/* Centres positions and scales them to a largest distance of 1, and references with them if they are equal. */
void mesh_normalize(triangle_mesh *mesh);

/* Computes area-weighted smooth normals of all vertices into normal[vertex_count]. */
void mesh_smooth_normals(const triangle_mesh *mesh, vec3 *normal);

/* Returns six times the enclosed volume, positive if triangles wind counter-clockwise seen from outside. */
double mesh_signed_volume(const triangle_mesh *mesh);

/* Merges the vertices of a mesh from a file: drops those that no triangle uses and, if normals are not known, merges
 * those at exactly one position, whatever else (texture coordinates, materials) separated them in the file. */
void mesh_weld(triangle_mesh *mesh);
/* Drops triangles that coincide with an earlier one of the same orientation, if they are half of all or more: every ray
 * there would test all of them. A few are harmless, and modelling programs leave some. */
void mesh_drop_repeated(triangle_mesh *mesh);

/* Drops triangles without area and unused vertices; computes the normals of vertices without them, splitting vertices
 * at edges where faces meet at more than the angle whose cosine is given. MERLIN_NO_MEMORY; MERLIN_BAD_INPUT if no
 * triangle is left. */
status mesh_finish(triangle_mesh *mesh, float crease_cosine);

#endif
