/* SPDX-License-Identifier: MIT */
/* Smooth unions of simple solids given by approximate signed distances, triangulated by surface nets. */
#ifndef MERLIN_LAB_SCENE_SHAPE_IMPLICIT_H
#define MERLIN_LAB_SCENE_SHAPE_IMPLICIT_H

#include "mesh/mesh.h"

typedef enum blob_kind { BLOB_ELLIPSOID, BLOB_CAPSULE, BLOB_BOX } blob_kind;

typedef struct blob {
    blob_kind kind;
    bool carve; /* subtracted instead of added */
    vec3 centre;
    mat3 rotation; /* from the solid's axes to the shape's */
    vec3 radii;    /* ellipsoid: radii; capsule: radius at -y, half length, radius at +y; box: half sides */
    float blend;   /* width of the smooth transition to earlier blobs */
} blob;

enum { BLOBS = 32 };
typedef struct implicit {
    int count;
    blob blob[BLOBS];
} implicit;

/* Adds one blob if there is room. */
void implicit_add(implicit *shape, blob b);

/* Returns the approximate signed distance, negative inside. */
float implicit_distance(const implicit *shape, vec3 p);

/* Adds the surface with about `cells` cells along its longest side (surface nets, Gibson 1998, each vertex then moved
 * onto the surface along the gradient). */
void mesh_add_implicit(triangle_mesh *mesh, const implicit *shape, int cells, uint8_t part);

#endif
