/* SPDX-License-Identifier: MIT */
#include "lab/scene/shape/implicit.h"

#include <stdlib.h>
#include <string.h>

#include "base/number.h"

void implicit_add(implicit *shape, blob b)
{
    if (shape->count < BLOBS) shape->blob[shape->count++] = b;
}

static float blob_distance(const blob *b, vec3 p)
{
    vec3 q = mat3_apply_transposed(&b->rotation, vec3_sub(p, b->centre)), s = b->radii;
    switch (b->kind) {
    case BLOB_ELLIPSOID: { /* to first order: |q/s| (|q/s| - 1) / |q/s²| */
        vec3 a = vec3_make(q.x / s.x, q.y / s.y, q.z / s.z), c = vec3_make(a.x / s.x, a.y / s.y, a.z / s.z);
        float k = vec3_length(a);
        return k * (k - 1) / max_of(vec3_length(c), 1e-6f);
    }
    case BLOB_CAPSULE: {
        float t = clamp(q.y / s.y, -1, 1), radius = s.x + (s.z - s.x) * 0.5f * (t + 1);
        return vec3_length(vec3_make(q.x, q.y - t * s.y, q.z)) - radius;
    }
    default: {
        float round = 0.3f * min_of(s.x, min_of(s.y, s.z));
        vec3 d = vec3_make(fabsf(q.x) - s.x + round, fabsf(q.y) - s.y + round, fabsf(q.z) - s.z + round);
        float inside = min_of(0, max_of(d.x, max_of(d.y, d.z)));
        vec3 out = vec3_make(max_of(d.x, 0), max_of(d.y, 0), max_of(d.z, 0));
        return vec3_length(out) + inside - round;
    }
    }
}

/* Returns the quadratic smooth minimum: min(a, b), rounded where they differ by less than k. */
static float smooth_minimum(float a, float b, float k)
{
    float h = max_of(k - fabsf(a - b), 0) / max_of(k, 1e-6f);
    return min_of(a, b) - 0.25f * h * h * k;
}

float implicit_distance(const implicit *shape, vec3 p)
{
    float d = 1e9f;
    for (int i = 0; i < shape->count; i++) {
        const blob *b = &shape->blob[i];
        float e = blob_distance(b, p);
        d = b->carve ? -smooth_minimum(-d, e, b->blend) : smooth_minimum(d, e, b->blend);
    }
    return d;
}

/* Samples of the distance on a lattice of n[0] x n[1] x n[2] points. */
typedef struct field {
    const implicit *shape;
    vec3 origin;
    float step;
    int n[3];
    float *value;
    uint32_t *vertex; /* mesh vertex of the cell whose lowest corner this is */
} field;

static size_t field_index(const field *f, int i, int j, int k)
{
    return ((size_t)i * (size_t)f->n[1] + (size_t)j) * (size_t)f->n[2] + (size_t)k;
}

static vec3 field_point(const field *f, float i, float j, float k)
{
    return vec3_make(f->origin.x + f->step * i, f->origin.y + f->step * j, f->origin.z + f->step * k);
}

enum { BLOCK = 4 };

/* Returns the blobs that matter within `reach` of p, where the distance is d: no others come within their blending
 * width. */
static implicit blobs_near(const implicit *shape, vec3 p, float d, float reach)
{
    implicit near = {0};
    for (int i = 0; i < shape->count; i++) {
        const blob *b = &shape->blob[i];
        float level = b->carve ? -d : d;
        if (blob_distance(b, p) < level + 2 * reach + 2 * b->blend) near.blob[near.count++] = *b;
    }
    return near;
}

/* Samples one block; far from the surface its centre's distance stands for the whole block. */
static void sample_block(field *f, int i0, int j0, int k0)
{
    float half = 0.5f * (BLOCK - 1), far = 1.4f * 1.7320508f * (half + 1) * f->step;
    vec3 middle = field_point(f, (float)i0 + half, (float)j0 + half, (float)k0 + half);
    float centre = implicit_distance(f->shape, middle);
    bool away = fabsf(centre) > far;
    implicit near = {0};
    if (!away) near = blobs_near(f->shape, middle, centre, far);
    for (int i = i0; i < i0 + BLOCK && i < f->n[0]; i++)
        for (int j = j0; j < j0 + BLOCK && j < f->n[1]; j++)
            for (int k = k0; k < k0 + BLOCK && k < f->n[2]; k++)
                f->value[field_index(f, i, j, k)] =
                    away ? centre : implicit_distance(&near, field_point(f, (float)i, (float)j, (float)k));
}

static vec3 onto_surface(const field *f, vec3 p)
{
    float h = 0.15f * f->step, d = implicit_distance(f->shape, p);
    vec3 g = vec3_make(implicit_distance(f->shape, vec3_make(p.x + h, p.y, p.z)) - d,
                       implicit_distance(f->shape, vec3_make(p.x, p.y + h, p.z)) - d,
                       implicit_distance(f->shape, vec3_make(p.x, p.y, p.z + h)) - d);
    float move = -d * h / max_of(vec3_dot(g, g), 1e-4f * h * h), far = 0.5f * f->step / max_of(vec3_length(g), 1e-9f);
    return vec3_fma(p, min_of(far, max_of(-far, move)), g);
}

/* Places the vertex of a cell: at the mean of its edges' intersections with the surface, then moved onto it. */
static void place_vertex(field *f, triangle_mesh *mesh, int i, int j, int k)
{
    float corner[8];
    int inside = 0;
    for (int c = 0; c < 8; c++) {
        corner[c] = f->value[field_index(f, i + (c & 1), j + ((c >> 1) & 1), k + (c >> 2))];
        inside += corner[c] < 0;
    }
    if (inside == 0 || inside == 8) return;
    float sum[3] = {0, 0, 0};
    int crossings = 0;
    for (int c = 0; c < 8; c++) {
        for (int axis = 0; axis < 3; axis++) {
            int d = c | (1 << axis);
            if (d == c || (corner[c] < 0) == (corner[d] < 0)) continue;
            float t = corner[c] / (corner[c] - corner[d]);
            for (int a = 0; a < 3; a++)
                sum[a] += a == axis ? t : (float)((c >> a) & 1);
            crossings++;
        }
    }
    float w = 1 / (float)crossings;
    vec3 p = field_point(f, (float)i + sum[0] * w, (float)j + sum[1] * w, (float)k + sum[2] * w);
    f->vertex[field_index(f, i, j, k)] = mesh_add_vertex(mesh, onto_surface(f, p));
}

/* Adds the quad across the lattice edge from `at` along `axis`, if the surface crosses it. */
static void join_cells(const field *f, triangle_mesh *mesh, const int at[3], int axis, uint8_t part)
{
    int next[3] = {at[0] + (axis == 0), at[1] + (axis == 1), at[2] + (axis == 2)};
    bool here = f->value[field_index(f, at[0], at[1], at[2])] < 0;
    bool there = f->value[field_index(f, next[0], next[1], next[2])] < 0;
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    if (here == there || at[u] == 0 || at[v] == 0) return;
    uint32_t corner[4];
    for (int c = 0; c < 4; c++) {
        int cell[3] = {at[0], at[1], at[2]};
        cell[u] -= c == 0 || c == 3;
        cell[v] -= c <= 1;
        corner[here ? c : 3 - c] = f->vertex[field_index(f, cell[0], cell[1], cell[2])];
    }
    for (int c = 0; c < 4; c++)
        if (corner[c] == UINT32_MAX) return; /* happens only by rounding at the edge of the lattice */
    mesh_add_quad(mesh, corner[0], corner[1], corner[2], corner[3], part);
}

static void field_bounds(field *f, int cells)
{
    real low[3] = {1e9f, 1e9f, 1e9f}, high[3] = {-1e9f, -1e9f, -1e9f};
    for (int i = 0; i < f->shape->count; i++) {
        const blob *b = &f->shape->blob[i];
        if (b->carve) continue;
        vec3 s = b->radii;
        if (b->kind == BLOB_CAPSULE) s = vec3_make(max_of(s.x, s.z), s.y + max_of(s.x, s.z), max_of(s.x, s.z));
        real centre[3] = {b->centre.x, b->centre.y, b->centre.z};
        for (int a = 0; a < 3; a++) {
            vec3 row = b->rotation.row[a];
            float reach = fabsf(row.x) * s.x + fabsf(row.y) * s.y + fabsf(row.z) * s.z + 0.25f * b->blend;
            low[a] = min_of(low[a], centre[a] - reach);
            high[a] = max_of(high[a], centre[a] + reach);
        }
    }
    float longest = max_of(high[0] - low[0], max_of(high[1] - low[1], high[2] - low[2]));
    f->step = longest / (float)cells;
    for (int a = 0; a < 3; a++)
        f->n[a] = (int)ceilf((high[a] - low[a]) / f->step) + 4;
    f->origin = vec3_make(low[0] - 1.5f * f->step, low[1] - 1.5f * f->step, low[2] - 1.5f * f->step);
}

static void polygonize(field *f, triangle_mesh *mesh, uint8_t part)
{
    for (int i = 0; i < f->n[0]; i += BLOCK)
        for (int j = 0; j < f->n[1]; j += BLOCK)
            for (int k = 0; k < f->n[2]; k += BLOCK)
                sample_block(f, i, j, k);
    for (int i = 0; i + 1 < f->n[0]; i++)
        for (int j = 0; j + 1 < f->n[1]; j++)
            for (int k = 0; k + 1 < f->n[2]; k++)
                place_vertex(f, mesh, i, j, k);
    for (int i = 0; i + 1 < f->n[0]; i++)
        for (int j = 0; j + 1 < f->n[1]; j++)
            for (int k = 0; k + 1 < f->n[2]; k++)
                for (int axis = 0; axis < 3; axis++)
                    join_cells(f, mesh, (int[3]){i, j, k}, axis, part);
}

void mesh_add_implicit(triangle_mesh *mesh, const implicit *shape, int cells, uint8_t part)
{
    field f = {.shape = shape};
    field_bounds(&f, cells);
    size_t points = (size_t)f.n[0] * (size_t)f.n[1] * (size_t)f.n[2];
    f.value = malloc(points * sizeof *f.value);
    f.vertex = malloc(points * sizeof *f.vertex);
    if (!f.value || !f.vertex) {
        mesh->failed = true;
    } else {
        memset(f.vertex, 0xff, points * sizeof *f.vertex);
        polygonize(&f, mesh, part);
    }
    free(f.value);
    free(f.vertex);
}
