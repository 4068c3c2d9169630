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

static void write_header(FILE *f, const surface_mesh *m)
{
    fprintf(f,
            "ply\nformat binary_little_endian 1.0\ncomment written by merlin\nelement vertex %zu\n"
            "property float x\nproperty float y\nproperty float z\n"
            "property float nx\nproperty float ny\nproperty float nz\n"
            "property uchar red\nproperty uchar green\nproperty uchar blue\n"
            "element face %zu\nproperty list uchar uint vertex_indices\nend_header\n",
            m->vertices, m->triangles);
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

static void write_vertices(FILE *f, const surface_mesh *m, const mesh_source *from)
{
    for (size_t v = 0; v < m->vertices; v++) {
        vec3 n = surface_mesh_normal(m, from, v);
        const float *p = m->position + 3 * v;
        ply_vertex out = {{p[0], p[1], p[2]}, {n.x, n.y, n.z}, {200, 200, 200}};
        for (int c = 0; c < 3 && from->albedo; c++) {
            int channels = from->albedo->channels;
            out.color[c] = srgb_code8(
                from->albedo->data[(size_t)m->pixel[v] * (size_t)channels + (size_t)(channels == 3 ? c : 0)]);
        }
        if (v == 0) out.position[0] = not_white(out.position[0]);
        fwrite(&out, sizeof out, 1, f);
    }
}

typedef struct ply {
    const surface_mesh *mesh;
    const mesh_source *from;
} ply;

static void write_mesh(FILE *f, const void *context)
{
    const ply *p = context;
    const surface_mesh *m = p->mesh;
    write_header(f, m);
    write_vertices(f, m, p->from);
    for (size_t t = 0; t < m->triangles; t++) {
        const uint32_t *i = m->index + 3 * t;
        ply_face face = {3, {i[0], i[1], i[2]}};
        fwrite(&face, sizeof face, 1, f);
    }
}

status mesh_write_ply(const char *path, const surface_mesh *m, const mesh_source *from)
{
    status s = surface_mesh_check_size(from, from->albedo); /* vertices have colours here, not a texture */
    return s == OK ? file_print(path, write_mesh, &(ply){m, from}) : s;
}
