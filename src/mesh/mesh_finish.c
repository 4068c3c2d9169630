/* SPDX-License-Identifier: MIT */
/* Finishes a mesh: removes triangles without area and unused vertices, computes normals with creases. */
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "mesh/mesh.h"

/* State of a pass over the vertices; faces around vertex v are face[start[v]] .. face[start[v + 1] - 1]. */
typedef struct finisher {
    triangle_mesh *mesh;
    uint32_t *start, *face;
    vec3 *unit;  /* per face: direction */
    float *area; /* per face: twice its area */
    vec3 *position, *reference, *normal;
    uint32_t count, capacity;
} finisher;

static bool drop_degenerate(finisher *f)
{
    triangle_mesh *m = f->mesh;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < m->triangle_count; i++) {
        const uint32_t *t = m->triangle[i];
        vec3 a = vec3_sub(m->position[t[1]], m->position[t[0]]), b = vec3_sub(m->position[t[2]], m->position[t[0]]);
        vec3 n = vec3_cross(a, b);
        float area = vec3_length(n);
        /* negated, so that a NaN is dropped too; slivers thinner than 1e-5 of their length have no usable normal */
        if (!(area > 1e-5f * max_of(vec3_dot(a, a), vec3_dot(b, b)) && area > 1e-13f && area < 1e30f)) continue;
        f->unit[kept] = vec3_scale(n, 1 / area);
        f->area[kept] = area;
        memmove(m->triangle[kept], t, sizeof *m->triangle);
        m->part[kept++] = m->part[i];
    }
    m->triangle_count = kept;
    return kept > 0;
}

static void collect_faces(finisher *f)
{
    triangle_mesh *m = f->mesh;
    memset(f->start, 0, (m->vertex_count + 2) * sizeof *f->start);
    for (uint32_t i = 0; i < m->triangle_count; i++)
        for (int k = 0; k < 3; k++)
            f->start[m->triangle[i][k] + 2]++;
    for (uint32_t v = 0; v < m->vertex_count; v++)
        f->start[v + 2] += f->start[v + 1];
    for (uint32_t i = 0; i < m->triangle_count; i++)
        for (int k = 0; k < 3; k++)
            f->face[f->start[m->triangle[i][k] + 1]++] = 3 * i + (uint32_t)k;
}

/* Writes one new vertex for the faces of v in group g and points their corners to it (kept as ~index until the end, so
 * that old and new indices never mix). */
static void emit(finisher *f, uint32_t v, const uint8_t *group, uint8_t g)
{
    triangle_mesh *m = f->mesh;
    vec3 sum = {0, 0, 0}, first = {0, 0, 0};
    for (uint32_t k = f->start[v]; k < f->start[v + 1]; k++) {
        uint32_t corner = f->face[k];
        if (group && group[k - f->start[v]] != g) continue;
        if (vec3_dot(first, first) == 0) first = f->unit[corner / 3];
        sum = vec3_fma(sum, f->area[corner / 3], f->unit[corner / 3]);
        m->triangle[corner / 3][corner % 3] = ~f->count;
    }
    vec3 normal = m->normal ? m->normal[v] : vec3_normalize(sum);
    if (!(vec3_dot(normal, normal) > 0.5f)) normal = first;
    f->position[f->count] = m->position[v];
    f->reference[f->count] = m->reference[v];
    f->normal[f->count++] = normal;
}

/* Most faces around a vertex, which are divided into groups that are smooth among themselves. */
enum { FACES = 48 };

static int group_faces(const finisher *f, uint32_t v, float crease_cosine, uint8_t *group)
{
    uint32_t begin = f->start[v], count = f->start[v + 1] - begin;
    for (uint32_t i = 0; i < count; i++)
        group[i] = (uint8_t)i;
    for (uint32_t i = 1; i < count; i++) {
        vec3 n = f->unit[f->face[begin + i] / 3];
        for (uint32_t j = 0; j < i; j++) {
            if (group[i] == group[j] || vec3_dot(n, f->unit[f->face[begin + j] / 3]) < crease_cosine) continue;
            uint8_t old = group[i], merged = group[j];
            for (uint32_t k = 0; k <= i; k++)
                if (group[k] == old) group[k] = merged;
        }
    }
    return (int)count;
}

static void split(finisher *f, float crease_cosine)
{
    for (uint32_t v = 0; v < f->mesh->vertex_count; v++) {
        uint32_t count = f->start[v + 1] - f->start[v];
        if (count == 0) continue;
        if (f->mesh->normal || count > FACES) {
            emit(f, v, NULL, 0);
            continue;
        }
        uint8_t group[FACES];
        int faces = group_faces(f, v, crease_cosine, group);
        for (int g = 0; g < faces; g++) {
            bool used = false;
            for (int k = 0; k < faces; k++)
                used |= group[k] == g;
            if (used) emit(f, v, group, (uint8_t)g);
        }
    }
}

static void take_over(finisher *f)
{
    triangle_mesh *m = f->mesh;
    for (uint32_t i = 0; i < m->triangle_count; i++)
        for (int k = 0; k < 3; k++)
            m->triangle[i][k] = ~m->triangle[i][k];
    free(m->position);
    free(m->reference);
    free(m->normal);
    m->position = f->position;
    m->reference = f->reference;
    m->normal = f->normal;
    m->vertex_count = f->count;
    m->vertex_capacity = f->capacity;
    f->position = f->reference = f->normal = NULL;
}

status mesh_finish(triangle_mesh *mesh, float crease_cosine)
{
    if (mesh->failed) return fail(MERLIN_NO_MEMORY, "no memory for a shape");
    /* at most one vertex a corner */
    uint32_t corners = 3 * mesh->triangle_count + 1;
    finisher f = {.mesh = mesh, .capacity = corners};
    f.start = malloc((mesh->vertex_count + 2) * sizeof *f.start);
    f.face = malloc(corners * sizeof *f.face);
    f.unit = malloc((mesh->triangle_count + 1) * sizeof *f.unit);
    f.area = malloc((mesh->triangle_count + 1) * sizeof *f.area);
    f.position = malloc(corners * sizeof *f.position);
    f.reference = malloc(corners * sizeof *f.reference);
    f.normal = malloc(corners * sizeof *f.normal);
    status s = OK;
    if (!f.start || !f.face || !f.unit || !f.area || !f.position || !f.reference || !f.normal) {
        s = fail(MERLIN_NO_MEMORY, "no memory for a shape of %u triangles", mesh->triangle_count);
    } else if (!drop_degenerate(&f)) {
        s = fail(MERLIN_BAD_INPUT, "a shape without a triangle that has an area");
    } else {
        collect_faces(&f);
        split(&f, crease_cosine);
        take_over(&f);
    }
    free(f.start);
    free(f.face);
    free(f.unit);
    free(f.area);
    free(f.position);
    free(f.reference);
    free(f.normal);
    return s;
}
