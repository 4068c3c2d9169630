/* SPDX-License-Identifier: MIT */
/* Polygons of more than three corners, cut into triangles by ear clipping (Meisters 1975). */
#include <string.h>

#include "mesh/mesh.h"

/* Returns a value above 0 if a -> b -> c turns counter-clockwise, seen against the polygon's normal n. */
static float turn(vec3 a, vec3 b, vec3 c, vec3 n)
{
    return vec3_dot(vec3_cross(vec3_sub(b, a), vec3_sub(c, b)), n);
}

/* Returns twice the area, along the normal; corners need not lie in a plane. */
static vec3 area_of(const triangle_mesh *mesh, const uint32_t *corner, int count)
{
    vec3 sum = {0, 0, 0}, first = mesh->position[corner[0]];
    for (int k = 2; k < count; k++) {
        vec3 a = vec3_sub(mesh->position[corner[k - 1]], first), b = vec3_sub(mesh->position[corner[k]], first);
        sum = vec3_add(sum, vec3_cross(a, b));
    }
    return sum;
}

/* Tells whether corner i may be cut off: the polygon is convex there, and no other corner lies inside. Subtracts the
 * number of corners tested from *work. */
static bool is_ear(const triangle_mesh *mesh, const uint32_t *corner, int count, int i, vec3 n, long *work)
{
    vec3 a = mesh->position[corner[(i + count - 1) % count]], b = mesh->position[corner[i]];
    vec3 c = mesh->position[corner[(i + 1) % count]];
    --*work;
    if (!(turn(a, b, c, n) > 0)) return false;
    for (int k = 2; k < count - 1; k++) {
        --*work;
        vec3 p = mesh->position[corner[(i + k) % count]];
        if (turn(a, b, p, n) > 0 && turn(b, c, p, n) > 0 && turn(c, a, p, n) > 0) return false;
    }
    return true;
}

void mesh_add_polygon(triangle_mesh *mesh, uint32_t *corner, int count, uint8_t part)
{
    if (mesh->failed || count < 3) return;
    vec3 n = vec3_normalize(area_of(mesh, corner, count));
    int i = 1, passed = 0;          /* beginning at the second corner, a convex polygon becomes a fan about the first */
    long work = 2L * count * count; /* twice what a simple polygon needs; beyond it, cut without tests */
    while (count > 3) {
        /* a self-intersecting polygon may have no ear, and is then cut anywhere */
        if (passed < count && work > 0 && !is_ear(mesh, corner, count, i, n, &work)) {
            i = (i + 1) % count;
            passed++;
            continue;
        }
        mesh_add_triangle(mesh, corner[(i + count - 1) % count], corner[i], corner[(i + 1) % count], part);
        count--;
        memmove(corner + i, corner + i + 1, (size_t)(count - i) * sizeof *corner);
        i %= count;
        passed = 0;
    }
    mesh_add_triangle(mesh, corner[0], corner[1], corner[2], part);
}
