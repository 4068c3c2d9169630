/* SPDX-License-Identifier: MIT */
/* glTF 2.0 (ISO/IEC 12113) as far as a surface needs it: the file with its buffers, accessors, and where its nodes put
 * its meshes. mesh_gltf.c makes a mesh of it.
 *
 *     gltf *g;
 *     status s = gltf_parse(bytes, size, folder, &g);
 *     gltf_accessor positions;
 *     if (s == OK) s = gltf_find_accessor(g, 0, &positions);
 *     double p[4];
 *     gltf_numbers(&positions, 17, p);
 *     gltf_close(g);
 *
 * Nothing in the file is trusted: sizes, places and counts are checked before they are used, no depth of anything
 * becomes a depth of calls, and only plain files are opened. */
#ifndef MERLIN_MESH_READ_GLTF_H
#define MERLIN_MESH_READ_GLTF_H

#include <cjson/cJSON.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/file.h"
#include "base/status.h"

/* An array of the document by number, which cJSON has as a chain only. */
typedef struct gltf_list {
    const cJSON **at;
    size_t count;
} gltf_list;

typedef struct gltf_buffer {
    bool loaded;
    const uint8_t *data;
    size_t size;
    uint8_t *decoded; /* of a data: URI */
    file_view file;   /* of any other */
} gltf_buffer;

/* An array of numbers or vectors. */
typedef struct gltf_accessor {
    bool known;
    size_t count, stride;
    const uint8_t *data; /* NULL: zeros, but for what is sparse */
    int type, components;
    bool normalized;
    size_t sparse_count;
    const uint8_t *sparse_index, *sparse_value; /* places that ascend, and what is there instead */
    int sparse_type;                            /* of the places */
} gltf_accessor;

typedef struct gltf {
    const char *folder; /* where its buffers lie; NULL: none may */
    file_view file;
    cJSON *root;
    gltf_list nodes, meshes, accessors, views, buffers;
    const uint8_t *binary; /* of a GLB */
    size_t binary_size;
    gltf_buffer *buffer;     /* of each of buffers, once it was asked for */
    gltf_accessor *accessor; /* of each of accessors, likewise */
    size_t bytes;            /* of the file and the buffers so far */
} gltf;

/* Reads all but the buffers, which come as they are needed; the bytes must outlive it. folder: where its files lie, or
 * NULL. MERLIN_BAD_INPUT for what is damaged, glTF 1, or requires an extension by which its surface is something else
 * than it says. */
status gltf_parse(const void *bytes, size_t size, const char *folder, gltf **out);
void gltf_close(gltf *g);

/* A count, place or number of the document: true, and *out is it or else the fallback, unless it is no whole number. */
bool gltf_whole(const cJSON *object, const char *key, size_t fallback, size_t *out);
status gltf_damaged(const char *what);
/* Bytes from `offset` on in a buffer, read, decoded or mapped at the first call. */
status gltf_find_bytes(gltf *g, size_t buffer, size_t offset, size_t size, const uint8_t **out);

enum { GLTF_SCALAR = 1, GLTF_VEC3 = 3 };
status gltf_find_accessor(gltf *g, size_t index, gltf_accessor *out);
/* Its i-th element as up to four numbers, integers as fractions where they are normalized; as a place, if it is one. */
void gltf_numbers(const gltf_accessor *a, size_t i, double *out);
size_t gltf_place(const gltf_accessor *a, size_t i);
/* Tells whether its elements can be places: whole and above 0. */
bool gltf_holds_places(const gltf_accessor *a);

/* A mesh where a node puts it: x' = m[0] x + m[1] y + m[2] z + m[3], and so on for y and z. */
typedef struct gltf_instance {
    size_t mesh;
    double m[12];
} gltf_instance;
/* The meshes of the document's scene: its default one, the first, or all nodes where there is none; malloc'ed. Refuses
 * nodes that are met twice, for they may be a tree only. */
status gltf_place_meshes(const gltf *g, gltf_instance **out, size_t *count);

#endif
