/* SPDX-License-Identifier: MIT */
/* Writes PLY, binary little-endian, with normals and vertex colours. */
#include <stdio.h>
#include <string.h>

#include "base/file.h"
#include "image/color.h"
#include "mesh/write/mesh_formats.h"

typedef struct __attribute__((packed)) ply_vertex {
    float position[3], normal[3];
    uint8_t color[3];
} ply_vertex;

typedef struct __attribute__((packed)) ply_face {
    uint8_t count;
    uint32_t index[3];
} ply_face;

static void write_header(FILE *f, const merlin_mesh *m)
{
    fprintf(f,
            "ply\nformat binary_little_endian 1.0\ncomment written by merlin\nelement vertex %zu\n"
            "property float x\nproperty float y\nproperty float z\n"
            "property float nx\nproperty float ny\nproperty float nz\n"
            "property uchar red\nproperty uchar green\nproperty uchar blue\n"
            "element face %zu\nproperty list uchar uint vertex_indices\nend_header\n",
            m->vertex_count, m->triangle_count);
}

/* Changes a float whose first byte is white space by sixteen units in the last place: some readers (assimp 5.2 among
 * them) skip white space after the header, and with it such a byte. */
static float not_white(float x)
{
    unsigned char bytes[sizeof x];
    memcpy(bytes, &x, sizeof x);
    if (bytes[0] == ' ' || (bytes[0] >= '\t' && bytes[0] <= '\r')) bytes[0] ^= 0x10;
    memcpy(&x, bytes, sizeof x);
    return x;
}

static void write_vertices(FILE *f, const merlin_mesh *m)
{
    for (size_t v = 0; v < m->vertex_count; v++) {
        const float *p = m->positions + 3 * v, *n = m->normals + 3 * v;
        ply_vertex out = {{p[0], p[1], p[2]}, {n[0], n[1], n[2]}, {200, 200, 200}};
        for (size_t c = 0; c < 3 && m->colors; c++)
            out.color[c] = srgb_code8(m->colors[3 * v + c]);
        if (v == 0) out.position[0] = not_white(out.position[0]);
        fwrite(&out, sizeof out, 1, f);
    }
}

static void write_mesh(FILE *f, const void *context)
{
    const merlin_mesh *m = context;
    write_header(f, m);
    write_vertices(f, m);
    for (size_t t = 0; t < m->triangle_count; t++) {
        const uint32_t *i = m->triangles + 3 * t;
        ply_face face = {3, {i[0], i[1], i[2]}};
        fwrite(&face, sizeof face, 1, f);
    }
}

status mesh_write_ply(const char *path, const merlin_mesh *m)
{
    return file_print(path, write_mesh, m);
}
