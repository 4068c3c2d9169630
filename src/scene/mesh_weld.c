/* Vertices as a surface needs them rather than as a file lists them. */
#include <stdlib.h>
#include <string.h>

#include "scene/mesh.h"

enum { UNUSED = 0, USED = 1 }; /* what becomes of a vertex, before its new index is known */

/* Places that were met, by hash with open addressing; a slot holds a vertex's new index + 1, 0 is free. */
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

/* The new index of the vertex at p: that of an earlier one there, else `next`. */
static uint32_t index_at(places *known, const scn_mesh *mesh, vec3 p, uint32_t next)
{
    p = vec3_add(p, (vec3){0, 0, 0}); /* -0 is 0 */
    for (size_t i = hash_of(p) & known->mask;; i = (i + 1) & known->mask) {
        if (known->slot[i] == 0) {
            known->slot[i] = next + 1;
            return next;
        }
        vec3 q = mesh->position[known->slot[i] - 1];
        if (q.x == p.x && q.y == p.y && q.z == p.z) return known->slot[i] - 1;
    }
}

/* Moves what is kept to the front; to[v] becomes the new index of vertex v, where it is used. */
static void renumber(scn_mesh *mesh, places *known, uint32_t *to)
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

void mesh_weld(scn_mesh *mesh)
{
    if (mesh->failed) return;
    places known = {.mask = 1};
    while (!mesh->normal && known.mask < 2 * (size_t)mesh->vertex_count)
        known.mask = 2 * known.mask + 1;
    uint32_t *to = calloc((size_t)mesh->vertex_count + 1, sizeof *to);
    known.slot = calloc(known.mask + 1, sizeof *known.slot);
    if (to && known.slot) {
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
