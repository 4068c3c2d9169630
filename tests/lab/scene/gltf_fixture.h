/* SPDX-License-Identifier: MIT */
/* glTF files assembled from parts, for the tests of their reader. */
#ifndef MERLIN_TESTS_SCENE_GLTF_FIXTURE_H
#define MERLIN_TESTS_SCENE_GLTF_FIXTURE_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"
#include "mesh/read/mesh_limits.h"
#include "mesh/read/mesh_read.h"
#include "mesh/read/mesh_read_gltf.h"
#include "scratch.h"

/* last, as cmocka defines a macro named fail */
#include <cmocka.h>

/* A document with one buffer: its bytes, the views and accessors that refer to them, and the rest as text. */
typedef struct document {
    uint8_t bytes[4096];
    size_t size;
    char views[2000], accessors[2000], meshes[2000], nodes[2000], more[2000];
    int view_count, accessor_count;
} document;

enum { BYTE = 5120, UNSIGNED_BYTE, SHORT, UNSIGNED_SHORT, UNSIGNED_INT = 5125, FLOAT };

static const float TRIANGLE[9] = {0, 0, 0, 2, 0, 0, 0, 3, 0};

static inline void append(char *text, size_t room, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    size_t end = strlen(text);
    vsnprintf(text + end, room - end, format, arguments);
    va_end(arguments);
}

/* Adds a view of the bytes and returns its number. */
static inline int add_view(document *d, const void *bytes, size_t size, int stride)
{
    memcpy(d->bytes + d->size, bytes, size);
    append(d->views, sizeof d->views, "%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu%s", *d->views ? "," : "",
           d->size, size, stride ? "" : "}");
    if (stride) append(d->views, sizeof d->views, ",\"byteStride\":%d}", stride);
    d->size += size;
    return d->view_count++;
}

static inline int add_accessor(document *d, const char *text)
{
    append(d->accessors, sizeof d->accessors, "%s{%s}", *d->accessors ? "," : "", text);
    return d->accessor_count++;
}

static inline int add_array(document *d, const void *bytes, size_t size, int type, int count, const char *shape)
{
    char text[200];
    snprintf(text, sizeof text, "\"bufferView\":%d,\"componentType\":%d,\"count\":%d,\"type\":\"%s\"",
             add_view(d, bytes, size, 0), type, count, shape);
    return add_accessor(d, text);
}

/* Writes the buffer as a data: URI, in base 64. */
static inline void put_uri(const document *d, char *out)
{
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    out += sprintf(out, "data:application/octet-stream;base64,");
    for (size_t i = 0; i < d->size; i += 3) {
        uint32_t word = (uint32_t)d->bytes[i] << 16 | (uint32_t)d->bytes[i + 1] << 8 | d->bytes[i + 2];
        for (int k = 0; k < 4; k++)
            *out++ = k > (int)(d->size - i) ? '=' : letters[word >> (18 - 6 * k) & 63];
    }
    *out = 0;
}

/* Returns the JSON; uri NULL: for a GLB, which holds the buffer. */
static inline char *json_of(const document *d, const char *uri)
{
    char *text = NULL;
    const char *before = uri ? ",\"uri\":\"" : "", *after = uri ? "\"" : "";
    assert_true(asprintf(&text,
                         "{\"asset\":{\"version\":\"2.0\"}%s,\"buffers\":[{\"byteLength\":%zu%s%s%s}],"
                         "\"bufferViews\":[%s],\"accessors\":[%s],\"meshes\":[%s],\"nodes\":[%s]}",
                         *d->more ? d->more : ",\"scenes\":[{\"nodes\":[0]}]", d->size, before, uri ? uri : "", after,
                         d->views, d->accessors, d->meshes, *d->nodes ? d->nodes : "{\"mesh\":0}") > 0);
    return text;
}

static inline status read_document(const document *d, triangle_mesh *mesh, int *parts)
{
    char uri[8000];
    put_uri(d, uri);
    char *text = json_of(d, uri);
    *mesh = (triangle_mesh){0};
    status s = mesh_parse_gltf(text, strlen(text), NULL, mesh, parts);
    free(text);
    return s;
}

static inline void must_read(const document *d, triangle_mesh *mesh, int *parts)
{
    if (read_document(d, mesh, parts) != OK) fail_msg("%s", status_message());
}

static inline void must_refuse(const document *d, const char *why)
{
    triangle_mesh mesh;
    int parts;
    assert_int_equal(read_document(d, &mesh, &parts), MERLIN_BAD_INPUT);
    if (!strstr(status_message(), why)) fail_msg("\"%s\" does not say \"%s\"", status_message(), why);
    mesh_free(&mesh);
}

static inline vec3 corner_of(const triangle_mesh *mesh, uint32_t triangle, int corner)
{
    return mesh->position[mesh->triangle[triangle][corner]];
}

static inline void assert_at(vec3 p, float x, float y, float z)
{
    if (fabsf(p.x - x) < 1e-6f && fabsf(p.y - y) < 1e-6f && fabsf(p.z - z) < 1e-6f) return;
    fail_msg("(%g %g %g) is not (%g %g %g)", (double)p.x, (double)p.y, (double)p.z, (double)x, (double)y, (double)z);
}

/* Returns one triangle, (0 0 0), (2 0 0), (0 3 0), without indices. */
static inline document triangle_document(void)
{
    document d = {0};
    add_array(&d, TRIANGLE, sizeof TRIANGLE, FLOAT, 3, "VEC3");
    append(d.meshes, sizeof d.meshes, "{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}");
    return d;
}

#endif
