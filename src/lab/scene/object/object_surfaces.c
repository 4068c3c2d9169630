/* SPDX-License-Identifier: MIT */
/* Evaluates points on an object's triangles: position, normals and material. */
#include "lab/scene/material/material.h"
#include "lab/scene/scene.h"

/* Corners of triangles, in camera space and in the material's space, and a point on each. */
typedef struct corners {
    lanes position[3], normal[3], reference[3];
    float u[LANES], v[LANES];
} corners;

/* The triangles' edges from the first corner and their cross product, in camera space (p) and in the material's (q). */
typedef struct patches {
    lanes p[2], q[2], cross_p, cross_q;
} patches;

/* Gathers the corners; lanes beyond count repeat the first. */
static void gather_corners(const scene_object *o, const scene_place *places, int count, corners *out)
{
    for (int i = 0; i < LANES; i++) {
        const scene_place *at = &places[i < count ? i : 0];
        for (int k = 0; k < 3; k++) {
            uint32_t vertex = o->triangle[at->triangle][k];
            lanes_put(&out->position[k], i, o->position[vertex]);
            lanes_put(&out->normal[k], i, o->normal[vertex]);
            lanes_put(&out->reference[k], i, o->reference[vertex]);
        }
        out->u[i] = at->u;
        out->v[i] = at->v;
    }
}

ALWAYS_INLINE vec3 interpolate(const corners *c, const lanes value[3], int i)
{
    real u = c->u[i], v = c->v[i];
    vec3 first = vec3_scale(lanes_at(&value[0], i), 1 - u - v);
    return vec3_fma(vec3_fma(first, u, lanes_at(&value[1], i)), v, lanes_at(&value[2], i));
}

static void make_patches(const corners *c, patches *out)
{
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
        vec3 p0 = lanes_at(&c->position[0], i), q0 = lanes_at(&c->reference[0], i);
        vec3 p1 = vec3_sub(lanes_at(&c->position[1], i), p0), p2 = vec3_sub(lanes_at(&c->position[2], i), p0);
        vec3 q1 = vec3_sub(lanes_at(&c->reference[1], i), q0), q2 = vec3_sub(lanes_at(&c->reference[2], i), q0);
        lanes_put(&out->p[0], i, p1);
        lanes_put(&out->p[1], i, p2);
        lanes_put(&out->q[0], i, q1);
        lanes_put(&out->q[1], i, q2);
        lanes_put(&out->cross_p, i, vec3_cross(p1, p2));
        lanes_put(&out->cross_q, i, vec3_cross(q1, q2));
    }
}

/* The surface without its material; the normals are the smooth ones. */
typedef struct surfaces {
    lanes position, geometric_normal, normal;
} surfaces;

static void interpolate_all(const corners *c, const patches *e, material_points *at, surfaces *out)
{
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
        lanes_put(&at->reference, i, interpolate(c, c->reference, i));
        lanes_put(&at->facing, i, vec3_normalize(lanes_at(&e->cross_q, i)));
        lanes_put(&out->position, i, interpolate(c, c->position, i));
        lanes_put(&out->geometric_normal, i, vec3_normalize(lanes_at(&e->cross_p, i)));
        lanes_put(&out->normal, i, vec3_normalize(interpolate(c, c->normal, i)));
    }
}

/* Perturbs the normals by the gradient of the material's height field in camera space (after Mikkelsen 2010): the
 * height's changes along two reference edges, transferred to the posed edges and scaled as the triangle was. */
static void bend_normals(const scene_material *material, const patches *e, const material_points *at, lanes *normal)
{
    lanes tangent[2];
    float d[2][LANES];
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
        vec3 along = vec3_normalize(lanes_at(&e->q[0], i));
        lanes_put(&tangent[0], i, along);
        lanes_put(&tangent[1], i, vec3_cross(lanes_at(&at->facing, i), along));
    }
    material_slope(material, at, tangent, d);
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
        vec3 q0 = lanes_at(&e->q[0], i), q1 = lanes_at(&e->q[1], i), cross_p = lanes_at(&e->cross_p, i);
        vec3 t0 = lanes_at(&tangent[0], i), t1 = lanes_at(&tangent[1], i);
        float area_p = vec3_length(cross_p), area_q = vec3_length(lanes_at(&e->cross_q, i));
        bool flat = !(area_q > 1e-4f * vec3_dot(q0, q0)) | (area_p <= 0);
        float scale = sqrtf(area_p / area_q), inverse = 1 / area_p;
        float along0 = scale * (d[0][i] * vec3_dot(t0, q0) + d[1][i] * vec3_dot(t1, q0));
        float along1 = scale * (d[0][i] * vec3_dot(t0, q1) + d[1][i] * vec3_dot(t1, q1));
        vec3 up = vec3_scale(cross_p, inverse);
        vec3 g = vec3_fma(vec3_scale(vec3_cross(lanes_at(&e->p[1], i), up), along0), along1,
                          vec3_cross(up, lanes_at(&e->p[0], i)));
        vec3 n = lanes_at(normal, i), bent = vec3_normalize(vec3_sub(n, vec3_scale(g, inverse)));
        lanes_put(normal, i, vec3_make(flat ? n.x : bent.x, flat ? n.y : bent.y, flat ? n.z : bent.z));
    }
}

/* Returns a normal that faces outward: one perturbed beyond that is moved back to grazing. */
static vec3 outward(vec3 n, vec3 geometric)
{
    float front = vec3_dot(n, geometric);
    if (!(front > 0.05f)) n = vec3_normalize(vec3_fma(n, 0.05f - front, geometric));
    return vec3_dot(n, n) > 0.5f ? n : geometric;
}

static void eval_lanes(const scene_object *object, const scene_place *places, int count, scene_surface *out)
{
    corners c;
    patches e;
    surfaces s;
    material_points at = {.wanted = lanes_first(count)};
    lanes albedo;
    float roughness[LANES];
    gather_corners(object, places, count, &c);
    for (int i = 0; i < LANES; i++)
        at.part[i] = object->part[places[i < count ? i : 0].triangle];
    make_patches(&c, &e);
    interpolate_all(&c, &e, &at, &s);
    material_eval(object->material, &at, &albedo, roughness);
    if (object->material->bumps || object->material->embossed) bend_normals(object->material, &e, &at, &s.normal);
    for (int i = 0; i < count; i++) {
        vec3 geometric = lanes_at(&s.geometric_normal, i);
        out[i] = (scene_surface){.position = lanes_at(&s.position, i),
                                 .geometric_normal = geometric,
                                 .normal = outward(lanes_at(&s.normal, i), geometric),
                                 .albedo = lanes_at(&albedo, i),
                                 .roughness = roughness[i]};
    }
}

void scene_surfaces_eval(const scene_object *object, const scene_place *places, int count, scene_surface *out)
{
    for (int done = 0; done < count; done += LANES)
        eval_lanes(object, places + done, count - done < LANES ? count - done : LANES, out + done);
}
