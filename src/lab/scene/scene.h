/* SPDX-License-Identifier: MIT */
/* Objects for rendering: triangles with a solid procedural material, made from (seed, index) alone or read from a mesh
 * file.
 *
 *     scn_object object;
 *     status s = scn_object_generate(seed, index, 60, &object);
 *     scn_surface at;
 *     scn_surfaces_eval(&object, &(scn_place){triangle, u, v}, 1, &at);
 *     scn_object_free(&object);
 */
#ifndef MERLIN_LAB_SCENE_SCENE_H
#define MERLIN_LAB_SCENE_SCENE_H

#include <stdint.h>

#include "base/status.h"
#include "base/vec.h"

typedef struct scn_material scn_material;

typedef struct scn_object {
    uint32_t vertex_count, triangle_count;
    vec3 *position;          /* camera space, the object near (0, 0, -1) */
    vec3 *normal;            /* unit, outward, smooth; camera space */
    vec3 *reference;         /* where the material is looked up: the undeformed, unposed place of the vertex */
    uint32_t (*triangle)[3]; /* counter-clockwise from outside */
    uint8_t *part;           /* per triangle: which primitive of the union it belongs to */
    scn_material *material;
    const char *shape; /* class name, static */
} scn_object;

/* What a ray sees at a point of the surface. */
typedef struct scn_surface {
    vec3 position;
    vec3 geometric_normal; /* unit, outward */
    vec3 normal;           /* unit, shading: smooth normal with the material's normal detail */
    vec3 albedo;           /* linear, [0, 1] */
    real roughness;        /* [0.1, 1] */
} scn_surface;

/* A random object, posed, filling 25 to 75 % of the frame of a camera with this horizontal field of view (degrees) and
 * a square frame, now and then near its edge. Deterministic from (seed, index). */
status scn_object_generate(uint64_t seed, uint64_t index, float fov, scn_object *out);

/* The mesh of an OBJ, PLY or glTF file, read once for any number of objects and threads. MERLIN_BAD_INPUT, with its
 * path, as of mesh_read. */
typedef struct scn_model scn_model;
status scn_model_read(const char *path, scn_model **out);
void scn_model_free(scn_model *model);

/* The model, scaled and posed at random from (seed, index) like a generated object, with a procedural material. */
status scn_object_from_model(const scn_model *model, uint64_t seed, uint64_t index, float fov, scn_object *out);

/* The same of another shape made out of it (scene/mesh_deform.h). */
status scn_object_from_deformed(const scn_model *model, uint64_t seed, uint64_t index, float fov, scn_object *out);

void scn_object_free(scn_object *object);

/* A point of a triangle: barycentric (u, v) are the weights of its second and third vertex, as Embree reports them. */
typedef struct scn_place {
    uint32_t triangle;
    real u, v;
} scn_place;

/* Sixteen places cost little more than one. Thread-safe. */
void scn_surfaces_eval(const scn_object *object, const scn_place *places, int count, scn_surface *out);

#endif
