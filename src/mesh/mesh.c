/* SPDX-License-Identifier: MIT */
#include "mesh/mesh.h"

#include <stdlib.h>
#include <string.h>

#include "base/number.h"

void mesh_free(triangle_mesh *mesh)
{
    free(mesh->position);
    free(mesh->reference);
    free(mesh->normal);
    free(mesh->triangle);
    free(mesh->part);
    *mesh = (triangle_mesh){0};
}

static void *copy_of(const void *array, size_t size)
{
    void *copy = array ? malloc(size ? size : 1) : NULL;
    return copy ? memcpy(copy, array, size) : NULL;
}

void mesh_copy(const triangle_mesh *mesh, triangle_mesh *out)
{
    size_t vertices = mesh->vertex_count, triangles = mesh->triangle_count;
    *out = *mesh;
    out->vertex_capacity = mesh->vertex_count;
    out->triangle_capacity = mesh->triangle_count;
    out->position = copy_of(mesh->position, vertices * sizeof *mesh->position);
    out->reference = copy_of(mesh->reference, vertices * sizeof *mesh->reference);
    out->normal = copy_of(mesh->normal, vertices * sizeof *mesh->normal);
    out->triangle = copy_of(mesh->triangle, triangles * sizeof *mesh->triangle);
    out->part = copy_of(mesh->part, triangles * sizeof *mesh->part);
    out->failed |= !out->position || !out->reference || !out->triangle || !out->part || (mesh->normal && !out->normal);
}

static bool grow(void **array, size_t count, size_t size)
{
    void *larger = realloc(*array, count * size);
    if (larger) *array = larger;
    return larger != NULL;
}

uint32_t mesh_add_vertex(triangle_mesh *mesh, vec3 position)
{
    if (mesh->failed) return 0;
    if (mesh->vertex_count == mesh->vertex_capacity) {
        uint32_t capacity = mesh->vertex_capacity ? 2 * mesh->vertex_capacity : 8192;
        if (!grow((void **)&mesh->position, capacity, sizeof(vec3)) ||
            !grow((void **)&mesh->reference, capacity, sizeof(vec3))) {
            mesh->failed = true;
            return 0;
        }
        mesh->vertex_capacity = capacity;
    }
    mesh->position[mesh->vertex_count] = mesh->reference[mesh->vertex_count] = position;
    return mesh->vertex_count++;
}

void mesh_add_triangle(triangle_mesh *mesh, uint32_t a, uint32_t b, uint32_t c, uint8_t part)
{
    if (mesh->failed) return;
    if (mesh->triangle_count == mesh->triangle_capacity) {
        uint32_t capacity = mesh->triangle_capacity ? 2 * mesh->triangle_capacity : 16384;
        if (!grow((void **)&mesh->triangle, capacity, sizeof *mesh->triangle) ||
            !grow((void **)&mesh->part, capacity, 1)) {
            mesh->failed = true;
            return;
        }
        mesh->triangle_capacity = capacity;
    }
    uint32_t *t = mesh->triangle[mesh->triangle_count];
    t[0] = a;
    t[1] = b;
    t[2] = c;
    mesh->part[mesh->triangle_count++] = part;
}

void mesh_add_quad(triangle_mesh *mesh, uint32_t a, uint32_t b, uint32_t c, uint32_t d, uint8_t part)
{
    if (mesh->failed) return;
    float ac = vec3_length(vec3_sub(mesh->position[a], mesh->position[c]));
    float bd = vec3_length(vec3_sub(mesh->position[b], mesh->position[d]));
    if (ac <= bd) {
        mesh_add_triangle(mesh, a, b, c, part);
        mesh_add_triangle(mesh, a, c, d, part);
    } else {
        mesh_add_triangle(mesh, a, b, d, part);
        mesh_add_triangle(mesh, b, c, d, part);
    }
}

void mesh_transform(triangle_mesh *mesh, uint32_t first, const mat3 *linear, vec3 offset, bool references)
{
    for (uint32_t i = first; i < mesh->vertex_count; i++) {
        mesh->position[i] = vec3_add(mat3_apply(linear, mesh->position[i]), offset);
        if (references) mesh->reference[i] = vec3_add(mat3_apply(linear, mesh->reference[i]), offset);
    }
}

void mesh_normalize(triangle_mesh *mesh)
{
    vec3 low = vec3_make(1e30f, 1e30f, 1e30f), high = vec3_scale(low, -1);
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        vec3 p = mesh->position[i];
        low = vec3_make(min_of(low.x, p.x), min_of(low.y, p.y), min_of(low.z, p.z));
        high = vec3_make(max_of(high.x, p.x), max_of(high.y, p.y), max_of(high.z, p.z));
    }
    vec3 centre = vec3_scale(vec3_add(low, high), 0.5f);
    float radius = 1e-12f;
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        radius = max_of(radius, vec3_length(vec3_sub(mesh->position[i], centre)));
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        mesh->position[i] = vec3_scale(vec3_sub(mesh->position[i], centre), 1 / radius);
        mesh->reference[i] = vec3_scale(vec3_sub(mesh->reference[i], centre), 1 / radius);
    }
}

static vec3 face_normal(const triangle_mesh *mesh, uint32_t triangle)
{
    const uint32_t *t = mesh->triangle[triangle];
    vec3 a = mesh->position[t[0]];
    return vec3_cross(vec3_sub(mesh->position[t[1]], a), vec3_sub(mesh->position[t[2]], a));
}

void mesh_smooth_normals(const triangle_mesh *mesh, vec3 *normal)
{
    memset(normal, 0, mesh->vertex_count * sizeof *normal);
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        vec3 n = face_normal(mesh, i);
        for (int k = 0; k < 3; k++) {
            uint32_t v = mesh->triangle[i][k];
            normal[v] = vec3_add(normal[v], n);
        }
    }
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        normal[i] = vec3_normalize(normal[i]);
}

double mesh_signed_volume(const triangle_mesh *mesh)
{
    double sum = 0;
    for (uint32_t i = 0; i < mesh->triangle_count; i++)
        sum += (double)vec3_dot(face_normal(mesh, i), mesh->position[mesh->triangle[i][0]]);
    return sum;
}
