/* SPDX-License-Identifier: MIT */
/* The part of glTF 2.0 (ISO/IEC 12113) that describes surfaces: the file with its buffers, accessors, and the placement
 * of meshes by nodes. mesh_read_gltf.c makes a mesh of it.
 *
 *     gltf *g;
 *     status s = gltf_parse(bytes, size, folder, &g);
 *     gltf_accessor positions;
 *     if (s == OK) s = gltf_find_accessor(g, 0, &positions);
 *     double p[4];
 *     gltf_numbers(&positions, 17, p);
 *     gltf_close(g);
 *
 * The file is not trusted: sizes, offsets and counts are checked before use, nesting in the file never becomes
 * recursion, and only plain files are opened. */
#ifndef MERLIN_MESH_READ_GLTF_H
#define MERLIN_MESH_READ_GLTF_H

#include <cjson/cJSON.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/file.h"
#include "base/status.h"

/* An array of the document, indexed; cJSON has it as a linked list only. */
typedef struct gltf_list {
    const cJSON **at;
    size_t count;
} gltf_list;

typedef struct gltf_buffer {
    bool loaded;
    const uint8_t *data;
    size_t size;
    uint8_t *decoded; /* content of a data: URI */
    file_view file;   /* content of a file */
} gltf_buffer;

/* An array of numbers or vectors. */
typedef struct gltf_accessor {
    bool known;
    size_t count, stride;
    const uint8_t *data; /* NULL: zeros, except for sparse values */
    int type, components;
    bool normalized;
    size_t sparse_count;
    const uint8_t *sparse_index, *sparse_value; /* ascending indices, and the values to use there */
    int sparse_type;                            /* type of the indices */
} gltf_accessor;

typedef struct gltf {
    const char *folder; /* folder of its buffers; NULL: no files are allowed */
    file_view file;
    cJSON *root;
    gltf_list nodes, meshes, accessors, views, buffers;
    const uint8_t *binary; /* binary chunk of a GLB */
    size_t binary_size;
    gltf_buffer *buffer;     /* one for each buffer, filled when it is needed */
    gltf_accessor *accessor; /* one for each accessor, likewise */
    size_t bytes;            /* size of the file and of the buffers so far */
} gltf;

/* Parses everything but the buffers, which are read when they are needed; the bytes must outlive it. folder: where its
 * files are, or NULL. MERLIN_BAD_INPUT for damaged files, glTF 1, and required extensions that change the surface. */
status gltf_parse(const void *bytes, size_t size, const char *folder, gltf **out);
void gltf_close(gltf *g);

/* Reads a count, index or other whole number: sets *out to it, or to the fallback if it is missing. Returns false if it
 * is not a whole number. */
bool gltf_whole(const cJSON *object, const char *key, size_t fallback, size_t *out);
status gltf_damaged(const char *what);
/* Returns bytes from `offset` on in a buffer, which is read, decoded or mapped at the first call. */
status gltf_find_bytes(gltf *g, size_t buffer, size_t offset, size_t size, const uint8_t **out);

enum { GLTF_SCALAR = 1, GLTF_VEC3 = 3 };
status gltf_find_accessor(gltf *g, size_t index, gltf_accessor *out);
/* Returns the i-th element as up to four numbers (normalized integers as fractions), or as an index. */
void gltf_numbers(const gltf_accessor *a, size_t i, double *out);
size_t gltf_place(const gltf_accessor *a, size_t i);
/* Tells whether the elements can be indices: unsigned integers. */
bool gltf_holds_places(const gltf_accessor *a);

/* A mesh as placed by a node: x' = m[0] x + m[1] y + m[2] z + m[3], and so on for y and z. */
typedef struct gltf_instance {
    size_t mesh;
    double m[12];
} gltf_instance;
/* Lists the meshes of the document's scene: its default one, else the first, or all nodes if there is none; malloc'ed.
 * Refuses nodes that are reached twice, as they must form a tree. */
status gltf_place_meshes(const gltf *g, gltf_instance **out, size_t *count);

#endif
