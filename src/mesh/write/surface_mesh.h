/* SPDX-License-Identifier: MIT */
/* A depth map as triangles, before it is written to a file. Internal. */
#ifndef MERLIN_MESH_WRITE_SURFACE_MESH_H
#define MERLIN_MESH_WRITE_SURFACE_MESH_H

#include <stdint.h>

#include "mesh/write/mesh_source.h"

typedef struct surface_mesh {
    size_t vertices, triangles;
    float *position; /* 3 a vertex, camera space */
    float *normal;   /* 3 a vertex, of the triangles around it */
    float *texture;  /* 2 a vertex, (0, 0) is the picture's top left corner */
    int *pixel;      /* index of the vertex's pixel in the maps */
    uint32_t *index; /* 3 a triangle, counter-clockwise from the camera */
} surface_mesh;

status surface_mesh_new(const mesh_source *from, surface_mesh *out);
void surface_mesh_free(surface_mesh *m);

/* Returns MERLIN_WRONG_USE unless the map (may be NULL) has a value for each of depth's. */
status surface_mesh_check_size(const mesh_source *from, const img *map);

/* Returns the vertex's normal: the map's if there is one, else the triangles'. */
vec3 surface_mesh_normal(const surface_mesh *m, const mesh_source *from, size_t vertex);

/* Copies albedo as 3 channels in [0, 1]: a single channel is repeated. */
status mesh_albedo(const img *albedo, img *out);

#endif
