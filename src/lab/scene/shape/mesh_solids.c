/* SPDX-License-Identifier: MIT */
/* The meshes that shapes are made of: a wrapped cube grid, a lathe, a tube. */
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "lab/scene/shape/mesh_solids.h"

typedef struct lattice {
    triangle_mesh *mesh;
    uint32_t *vertex; /* (n + 1)^3, UINT32_MAX where there is none yet */
    int n;
    vec3 (*map)(const void *context, vec3 cube);
    const void *context;
} lattice;

static uint32_t lattice_vertex(lattice *l, const int at[3])
{
    int m = l->n + 1;
    uint32_t *v = &l->vertex[(at[0] * m + at[1]) * m + at[2]];
    if (*v == UINT32_MAX) {
        float step = 2.0f / (float)l->n;
        vec3 cube = vec3_make((float)at[0] * step - 1, (float)at[1] * step - 1, (float)at[2] * step - 1);
        *v = mesh_add_vertex(l->mesh, l->map(l->context, cube));
    }
    return *v;
}

static void lattice_face(lattice *l, int axis, int side, uint8_t part)
{
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int i = 0; i < l->n; i++) {
        for (int j = 0; j < l->n; j++) {
            uint32_t corner[4];
            for (int k = 0; k < 4; k++) {
                int at[3];
                at[axis] = side * l->n;
                at[u] = i + (k == 1 || k == 2);
                at[v] = j + (k >= 2);
                corner[side ? k : 3 - k] = lattice_vertex(l, at);
            }
            mesh_add_quad(l->mesh, corner[0], corner[1], corner[2], corner[3], part);
        }
    }
}

void mesh_add_cube_grid(triangle_mesh *mesh, int n, uint8_t part, vec3 (*map)(const void *context, vec3 cube),
                        const void *context)
{
    size_t points = (size_t)(n + 1) * (size_t)(n + 1) * (size_t)(n + 1);
    lattice l = {mesh, malloc(points * sizeof(uint32_t)), n, map, context};
    if (!l.vertex) {
        mesh->failed = true;
        return;
    }
    memset(l.vertex, 0xff, points * sizeof(uint32_t));
    for (int axis = 0; axis < 3; axis++) {
        lattice_face(&l, axis, 0, part);
        lattice_face(&l, axis, 1, part);
    }
    free(l.vertex);
}

void lathe_profile_add(lathe_profile *p, float radius, float height)
{
    if (p->count == PROFILE_POINTS) return;
    p->radius[p->count] = max_of(radius, 0);
    p->height[p->count++] = height;
}

void lathe_profile_add_corner(lathe_profile *p, const float from[2], const float corner[2], const float to[2],
                              float round, int steps)
{
    float a = hypotf(from[0] - corner[0], from[1] - corner[1]), b = hypotf(to[0] - corner[0], to[1] - corner[1]);
    float ta = min_of(0.5f, round / max_of(a, 1e-6f)), tb = min_of(0.5f, round / max_of(b, 1e-6f));
    for (int i = 0; i <= steps; i++) {
        float t = (float)i / (float)steps, wa = (1 - t) * (1 - t) * ta, wb = t * t * tb, wc = 1 - wa - wb;
        lathe_profile_add(p, wa * from[0] + wc * corner[0] + wb * to[0], wa * from[1] + wc * corner[1] + wb * to[1]);
    }
}

/* Adds one ring of the lathe; on the axis all its vertices are the same. */
static void lathe_ring(triangle_mesh *mesh, float radius, float height, int segments, uint32_t *ring)
{
    if (radius < 1e-5f) {
        uint32_t pole = mesh_add_vertex(mesh, vec3_make(0, height, 0));
        for (int j = 0; j < segments; j++)
            ring[j] = pole;
        return;
    }
    for (int j = 0; j < segments; j++) {
        float angle = 2 * PI * (float)j / (float)segments;
        ring[j] = mesh_add_vertex(mesh, vec3_make(radius * cosf(angle), height, radius * sinf(angle)));
    }
}

static void join_rings(triangle_mesh *mesh, const uint32_t *below, const uint32_t *above, int segments, uint8_t part)
{
    for (int j = 0; j < segments; j++) {
        int k = (j + 1) % segments;
        if (below[j] == below[k])
            mesh_add_triangle(mesh, below[j], above[j], above[k], part);
        else if (above[j] == above[k])
            mesh_add_triangle(mesh, below[j], above[j], below[k], part);
        else
            mesh_add_quad(mesh, below[j], above[j], above[k], below[k], part);
    }
}

void mesh_add_lathe(triangle_mesh *mesh, const lathe_profile *p, int segments, uint8_t part)
{
    uint32_t *rings = calloc((size_t)segments * (size_t)(p->count + 1), sizeof *rings);
    if (!rings) {
        mesh->failed = true;
        return;
    }
    for (int i = 0; i < p->count; i++)
        lathe_ring(mesh, p->radius[i], p->height[i], segments, rings + (size_t)i * (size_t)segments);
    for (int i = 0; i + 1 < p->count + p->closed; i++)
        join_rings(mesh, rings + (size_t)i * (size_t)segments, rings + (size_t)((i + 1) % p->count) * (size_t)segments,
                   segments, part);
    free(rings);
}

static vec3 path_direction(const vec3 *path, int count, int i)
{
    int before = i > 0 ? i - 1 : 0, after = i + 1 < count ? i + 1 : count - 1;
    return vec3_normalize(vec3_sub(path[after], path[before]));
}

void mesh_add_tube(triangle_mesh *mesh, const vec3 *path, const float *radius, int count, int segments, float aspect,
                   uint8_t part)
{
    uint32_t *rings = malloc(2 * (size_t)segments * sizeof *rings), *ring = rings;
    if (!rings) {
        mesh->failed = true;
        return;
    }
    uint32_t *last = rings + segments;
    vec3 direction = path_direction(path, count, 0);
    vec3 helper = fabsf(direction.z) < 0.9f ? vec3_make(0, 0, 1) : vec3_make(1, 0, 0);
    vec3 side = vec3_normalize(vec3_cross(direction, helper));
    for (int i = -1; i <= count; i++) {
        int at = i < 0 ? 0 : i < count ? i : count - 1;
        direction = path_direction(path, count, at);
        side = vec3_normalize(vec3_fma(side, -vec3_dot(side, direction), direction)); /* parallel transport */
        vec3 up = vec3_cross(direction, side);
        bool end = i != at;
        uint32_t pole = end ? mesh_add_vertex(mesh, path[at]) : 0;
        for (int j = 0; j < segments; j++) {
            float angle = -2 * PI * (float)j / (float)segments, r = radius[at];
            vec3 p = vec3_fma(vec3_fma(path[at], r * cosf(angle), side), r * aspect * sinf(angle), up);
            ring[j] = end ? pole : mesh_add_vertex(mesh, p);
        }
        if (i >= 0) join_rings(mesh, last, ring, segments, part);
        uint32_t *swap = last;
        last = ring;
        ring = swap;
    }
    free(rings);
}
