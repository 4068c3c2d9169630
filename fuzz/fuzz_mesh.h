/* SPDX-License-Identifier: MIT */
/* Meshes from arbitrary bytes: whatever is accepted must be made of vertices that are there, and finite. */
#ifndef MERLIN_FUZZ_MESH_H
#define MERLIN_FUZZ_MESH_H

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/read/mesh_read.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static inline void fuzz_check_mesh(triangle_mesh *mesh, status read, int parts)
{
    if (read != OK && strchr(status_message(), '\n')) abort();
    if (read == OK && mesh->triangle_count > 0) {
        if (parts < 1 || parts > MESH_PARTS) abort();
        for (uint32_t t = 0; t < mesh->triangle_count; t++) {
            if (mesh->part[t] >= parts) abort();
            for (int k = 0; k < 3; k++)
                if (mesh->triangle[t][k] >= mesh->vertex_count) abort();
        }
        for (uint32_t v = 0; v < mesh->vertex_count; v++) {
            if (!isfinite(vec3_length(mesh->position[v]))) abort();
            if (mesh->normal && !isfinite(vec3_length(mesh->normal[v]))) abort();
        }
        mesh_drop_repeated(mesh);
        mesh_weld(mesh);
        mesh_normalize(mesh);
        (void)mesh_finish(mesh, 0.6f);
    }
    mesh_free(mesh);
}

/* The bytes with a zero behind them, malloc'ed, so that reading beyond it is found. */
static inline char *fuzz_text(const uint8_t *data, size_t size)
{
    char *text = malloc(size + 1);
    if (!text) abort();
    if (size > 0) memcpy(text, data, size);
    text[size] = 0;
    return text;
}

#endif
