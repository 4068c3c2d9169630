/* SPDX-License-Identifier: MIT */
/* Objects for rendering: triangles with a solid procedural material, generated from (seed, index) alone or read from a
 * mesh file.
 *
 *     scene_object object;
 *     status s = scene_object_generate(seed, index, 60, &object);
 *     scene_surface at;
 *     scene_surfaces_eval(&object, &(scene_place){triangle, u, v}, 1, &at);
 *     scene_object_free(&object);
 */
#ifndef MERLIN_LAB_SCENE_SCENE_H
#define MERLIN_LAB_SCENE_SCENE_H

#include <stdint.h>

#include "base/status.h"
#include "base/vec.h"

typedef struct scene_material scene_material;

typedef struct scene_object {
    uint32_t vertex_count, triangle_count;
    vec3 *position;          /* camera space, the object near (0, 0, -1) */
    vec3 *normal;            /* unit, outward, smooth; camera space */
    vec3 *reference;         /* coordinates of the material: the vertex's undeformed, unposed position */
    uint32_t (*triangle)[3]; /* counter-clockwise from outside */
    uint8_t *part;           /* per triangle: the primitive of the union that it belongs to */
    scene_material *material;
    const char *shape; /* class name, static */
} scene_object;

/* The surface at a point hit by a ray. */
typedef struct scene_surface {
    vec3 position;
    vec3 geometric_normal; /* unit, outward */
    vec3 normal;           /* unit, for shading: smooth normal with the material's normal detail */
    vec3 albedo;           /* linear, [0, 1] */
    real roughness;        /* [0.1, 1] */
} scene_surface;

/* Generates a random object, posed to fill 25 to 75 % of the square frame of a camera with this horizontal field of
 * view (degrees), sometimes near the frame's edge. Deterministic from (seed, index). */
status scene_object_generate(uint64_t seed, uint64_t index, float fov, scene_object *out);

/* The mesh of an OBJ, PLY or glTF file, read once for any number of objects and threads. MERLIN_BAD_INPUT, with the
 * file's path, as for mesh_read. */
typedef struct scene_model scene_model;
status scene_model_read(const char *path, scene_model **out);
void scene_model_free(scene_model *model);

/* Makes an object from the model, scaled and posed at random from (seed, index) like a generated object, with a
 * procedural material. */
status scene_object_from_model(const scene_model *model, uint64_t seed, uint64_t index, float fov, scene_object *out);

/* Makes an object from a deformed copy of the model (scene/mesh_deform.h). */
status scene_object_from_deformed(const scene_model *model, uint64_t seed, uint64_t index, float fov,
                                  scene_object *out);

void scene_object_free(scene_object *object);

/* A point of a triangle: barycentric (u, v) are the weights of its second and third vertex, as Embree reports them. */
typedef struct scene_place {
    uint32_t triangle;
    real u, v;
} scene_place;

/* Evaluates `count` points; sixteen cost little more than one. Thread-safe. */
void scene_surfaces_eval(const scene_object *object, const scene_place *places, int count, scene_surface *out);

#endif
