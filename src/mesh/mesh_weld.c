/* SPDX-License-Identifier: MIT */
/* Merges vertices and drops triangles that a file lists repeatedly. */
#include <stdlib.h>
#include <string.h>

#include "mesh/mesh.h"

enum { UNUSED = 0, USED = 1 }; /* state of a vertex before its new index is known */

/* Positions seen so far, in a hash table with open addressing; a slot holds a vertex's new index + 1, 0 is free. */
typedef struct places {
    uint32_t *slot;
    size_t mask;
} places;

static uint64_t hash_of(vec3 p)
{
    uint32_t bits[3];
    memcpy(bits, &p, sizeof bits);
    uint64_t h = 0;
    for (int k = 0; k < 3; k++) {
        h = (h ^ bits[k]) * 0x9e3779b97f4a7c15u;
        h ^= h >> 29;
    }
    return h;
}

/* Allocates slots for `count` entries, at most half of them in use. */
static bool places_make(places *known, size_t count)
{
    known->mask = 1;
    while (known->mask < 2 * count)
        known->mask = 2 * known->mask + 1;
    known->slot = calloc(known->mask + 1, sizeof *known->slot);
    return known->slot != NULL;
}

/* Returns the new index of the vertex at p: that of an earlier one there, else `next`. */
static uint32_t index_at(places *known, const triangle_mesh *mesh, vec3 p, uint32_t next)
{
    p = vec3_add(p, (vec3){0, 0, 0}); /* turns -0 into 0 */
    for (size_t i = hash_of(p) & known->mask;; i = (i + 1) & known->mask) {
        if (known->slot[i] == 0) {
            known->slot[i] = next + 1;
            return next;
        }
        vec3 q = mesh->position[known->slot[i] - 1];
        if (q.x == p.x && q.y == p.y && q.z == p.z) return known->slot[i] - 1;
    }
}

/* Moves the vertices that are kept to the front; to[v] becomes the new index of a used vertex v. */
static void renumber(triangle_mesh *mesh, places *known, uint32_t *to)
{
    uint32_t kept = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        if (to[v] == UNUSED) continue;
        to[v] = mesh->normal ? kept : index_at(known, mesh, mesh->position[v], kept);
        if (to[v] < kept) continue;
        mesh->position[kept] = mesh->position[v];
        mesh->reference[kept] = mesh->reference[v];
        if (mesh->normal) mesh->normal[kept] = mesh->normal[v];
        kept++;
    }
    mesh->vertex_count = kept;
}

void mesh_weld(triangle_mesh *mesh)
{
    if (mesh->failed) return;
    places known = {0};
    uint32_t *to = calloc((size_t)mesh->vertex_count + 1, sizeof *to);
    if (places_make(&known, mesh->normal ? 0 : mesh->vertex_count) && to) {
        for (uint32_t i = 0; i < mesh->triangle_count; i++)
            for (int k = 0; k < 3; k++)
                to[mesh->triangle[i][k]] = USED;
        renumber(mesh, &known, to);
        for (uint32_t i = 0; i < mesh->triangle_count; i++)
            for (int k = 0; k < 3; k++)
                mesh->triangle[i][k] = to[mesh->triangle[i][k]];
    } else {
        mesh->failed = true;
    }
    free(known.slot);
    free(to);
}

/* Returns a triangle's corner positions, rotated to begin with the smallest. */
static void places_of(const triangle_mesh *mesh, const uint32_t t[3], vec3 out[3])
{
    int first = 0;
    vec3 p[3];
    for (int k = 0; k < 3; k++) {
        p[k] = vec3_add(mesh->position[t[k]], (vec3){0, 0, 0}); /* turns -0 into 0 */
        const vec3 a = p[k], b = p[first];
        if (a.x < b.x || (a.x == b.x && (a.y < b.y || (a.y == b.y && a.z < b.z)))) first = k;
    }
    for (int k = 0; k < 3; k++)
        out[k] = p[(first + k) % 3];
}

static bool is_same(const vec3 a[3], const vec3 b[3])
{
    for (int k = 0; k < 3; k++)
        if (a[k].x != b[k].x || a[k].y != b[k].y || a[k].z != b[k].z) return false;
    return true;
}

/* Tells whether no earlier triangle has these corners, and records this one. */
static bool is_new(places *known, const triangle_mesh *mesh, const uint32_t t[3], uint32_t index)
{
    vec3 here[3], there[3];
    places_of(mesh, t, here);
    uint64_t hash = hash_of(here[0]) ^ 3 * hash_of(here[1]) ^ 5 * hash_of(here[2]);
    for (size_t i = hash & known->mask;; i = (i + 1) & known->mask) {
        if (known->slot[i] == 0) {
            known->slot[i] = index + 1;
            return true;
        }
        places_of(mesh, mesh->triangle[known->slot[i] - 1], there);
        if (is_same(here, there)) return false;
    }
}

/* Returns the number of triangles without those that repeat an earlier one; removes them if `drop`. */
static uint32_t without_repeated(triangle_mesh *mesh, places *known, bool drop)
{
    uint32_t kept = 0;
    memset(known->slot, 0, (known->mask + 1) * sizeof *known->slot);
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        if (!is_new(known, mesh, mesh->triangle[i], drop ? kept : i)) continue;
        if (drop) {
            memmove(mesh->triangle[kept], mesh->triangle[i], sizeof *mesh->triangle);
            mesh->part[kept] = mesh->part[i];
        }
        kept++;
    }
    return kept;
}

void mesh_drop_repeated(triangle_mesh *mesh)
{
    if (mesh->failed) return;
    places known = {0};
    mesh->failed = !places_make(&known, mesh->triangle_count);
    if (!mesh->failed && without_repeated(mesh, &known, false) <= mesh->triangle_count / 2)
        mesh->triangle_count = without_repeated(mesh, &known, true);
    free(known.slot);
}
