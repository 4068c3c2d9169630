/* SPDX-License-Identifier: MIT */
/* Objects and materials simple enough for closed forms. */
#ifndef MERLIN_TESTS_RENDER_SHAPES_H
#define MERLIN_TESTS_RENDER_SHAPES_H

#include <stdlib.h>

#include "lab/scene/scene.h"

/* Allocates a test's object in static arrays, so that scene_object_free is not needed. */
static inline scene_object shape_alloc(uint32_t vertices, uint32_t triangles)
{
    scene_object o = {.vertex_count = vertices, .triangle_count = triangles, .shape = "test"};
    o.position = calloc(vertices, sizeof *o.position);
    o.normal = calloc(vertices, sizeof *o.normal);
    o.triangle = calloc(triangles, sizeof *o.triangle);
    return o;
}

static inline void shape_free(scene_object *o)
{
    free(o->position);
    free(o->normal);
    free(o->triangle);
}

/* Makes a sphere of rows × 2 rows quads. */
static inline scene_object shape_sphere(vec3 centre, float radius, uint32_t rows)
{
    uint32_t around = 2 * rows;
    scene_object o = shape_alloc((rows + 1) * (around + 1), 2 * rows * around);
    for (uint32_t i = 0; i <= rows; i++)
        for (uint32_t j = 0; j <= around; j++) {
            float theta = 3.14159265f * (float)i / (float)rows, phi = 6.2831853f * (float)j / (float)around;
            vec3 n = {sinf(theta) * cosf(phi), cosf(theta), sinf(theta) * sinf(phi)};
            o.normal[i * (around + 1) + j] = n;
            o.position[i * (around + 1) + j] = vec3_fma(centre, radius, n);
        }
    uint32_t t = 0;
    for (uint32_t i = 0; i < rows; i++)
        for (uint32_t j = 0; j < around; j++) {
            uint32_t a = i * (around + 1) + j, b = a + 1, c = a + around + 1, d = c + 1;
            uint32_t first[3] = {a, b, c}, second[3] = {b, d, c};
            for (int k = 0; k < 3; k++) {
                o.triangle[t][k] = first[k];
                o.triangle[t + 1][k] = second[k];
            }
            t += 2;
        }
    return o;
}

/* A parallelogram: an origin and two edges; the normal is edge1 × edge2. */
typedef struct shape_quad {
    vec3 origin, edge1, edge2;
} shape_quad;

static inline scene_object shape_quads(const shape_quad *quads, uint32_t count)
{
    scene_object o = shape_alloc(4 * count, 2 * count);
    for (uint32_t i = 0; i < count; i++) {
        vec3 n = vec3_normalize(vec3_cross(quads[i].edge1, quads[i].edge2));
        vec3 a = quads[i].origin, b = vec3_add(a, quads[i].edge1), d = vec3_add(a, quads[i].edge2);
        vec3 corner[4] = {a, b, vec3_add(b, quads[i].edge2), d};
        static const uint32_t order[2][3] = {{0, 1, 2}, {0, 2, 3}};
        for (int k = 0; k < 4; k++) {
            o.position[4 * i + (uint32_t)k] = corner[k];
            o.normal[4 * i + (uint32_t)k] = n;
        }
        for (int k = 0; k < 3; k++) {
            o.triangle[2 * i][k] = 4 * i + order[0][k];
            o.triangle[2 * i + 1][k] = 4 * i + order[1][k];
        }
    }
    return o;
}

/* Sets position and both normals as the real lookup does, with a grey albedo of one half and roughness 0.4. */
static inline void shape_grey_point(const scene_object *o, const scene_place *at, scene_surface *out)
{
    const uint32_t *t = o->triangle[at->triangle];
    real u = at->u, v = at->v;
    vec3 a = o->position[t[0]], b = o->position[t[1]], c = o->position[t[2]];
    vec3 n = vec3_scale(o->normal[t[0]], 1 - u - v);
    out->position = vec3_fma(vec3_fma(vec3_scale(a, 1 - u - v), u, b), v, c);
    out->normal = vec3_normalize(vec3_fma(vec3_fma(n, u, o->normal[t[1]]), v, o->normal[t[2]]));
    out->geometric_normal = vec3_normalize(vec3_cross(vec3_sub(b, a), vec3_sub(c, a)));
    if (vec3_dot(out->geometric_normal, out->normal) < 0) out->geometric_normal = vec3_scale(out->geometric_normal, -1);
    out->albedo = vec3_make(0.5f, 0.5f, 0.5f);
    out->roughness = 0.4f;
}

static inline void shape_grey(const scene_object *o, const scene_place *places, int count, scene_surface *out)
{
    for (int i = 0; i < count; i++)
        shape_grey_point(o, &places[i], &out[i]);
}

/* Evaluates points with colour and roughness that vary smoothly over space. */
static inline void shape_patterned(const scene_object *o, const scene_place *places, int count, scene_surface *out)
{
    for (int i = 0; i < count; i++) {
        scene_surface *s = &out[i];
        shape_grey_point(o, &places[i], s);
        vec3 p = s->position;
        s->albedo = vec3_make(0.5f + 0.4f * sinf(9 * p.x), 0.5f + 0.4f * sinf(11 * p.y), 0.5f + 0.3f * sinf(7 * p.z));
        s->roughness = 0.5f + 0.3f * sinf(8 * (p.x + p.y));
    }
}

#endif
