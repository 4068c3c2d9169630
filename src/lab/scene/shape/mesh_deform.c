/* SPDX-License-Identifier: MIT */
#include "lab/scene/shape/mesh_deform.h"

#include <stdlib.h>

#include "lab/scene/shape/shape.h"

static void mirror(triangle_mesh *mesh)
{
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        mesh->position[i].x = -mesh->position[i].x;
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        uint32_t *t = mesh->triangle[i], swap = t[1];
        t[1] = t[2];
        t[2] = swap;
    }
}

/* Stretches along random axes, by up to 1.4 times each. */
static void stretch(rng *r, triangle_mesh *mesh)
{
    const mat3 turn = random_rotation(r);
    const vec3 by = {expf(rng_range(r, -0.34f, 0.34f)), expf(rng_range(r, -0.34f, 0.34f)),
                     expf(rng_range(r, -0.34f, 0.34f))};
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        vec3 p = vec3_mul(mat3_apply(&turn, mesh->position[i]), by);
        mesh->position[i] = mat3_apply_transposed(&turn, p);
    }
}

void mesh_deform(rng *r, triangle_mesh *mesh)
{
    bool as_it_is = rng_uniform(r) < 1.0f / 3, mirrored = rng_uniform(r) < 0.5f;
    bool stretched = rng_uniform(r) < 0.6f, bent = rng_uniform(r) < 0.5f, dented = rng_uniform(r) < 0.4f;
    /* the file's normals belong to the undeformed shape */
    free(mesh->normal);
    mesh->normal = NULL;
    if (as_it_is) return;
    if (mirrored) mirror(mesh);
    if (stretched) stretch(r, mesh);
    if (bent) bend_and_twist(r, mesh, 0);
    if (dented) random_dents(r, mesh, 0, rng_range(r, 0.01f, 0.08f), 1, 6);
}
