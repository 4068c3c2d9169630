/* SPDX-License-Identifier: MIT */
#include "lab/scene/shape/mesh_displace.h"

#include <stdlib.h>

#include "lab/scene/shape/noise.h"

void mesh_displace(triangle_mesh *mesh, uint32_t first, float amount, float frequency, int octaves, uint32_t seed)
{
    if (mesh->failed || amount == 0) return;
    vec3 *normal = malloc(mesh->vertex_count * sizeof *normal);
    if (!normal) {
        mesh->failed = true;
        return;
    }
    mesh_smooth_normals(mesh, normal);
    for (uint32_t i = first; i < mesh->vertex_count; i++) {
        float height = amount * noise_fbm(vec3_scale(mesh->reference[i], frequency), octaves, seed);
        mesh->position[i] = vec3_fma(mesh->position[i], height, normal[i]);
    }
    free(normal);
}
