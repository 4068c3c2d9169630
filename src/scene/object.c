/* Objects put together: shape, pose, material; and what a ray sees on them. */
#include <stdlib.h>

#include "scene/material.h"
#include "scene/mesh_file.h"
#include "scene/pose.h"
#include "scene/scene.h"

/* Streams of random numbers, apart so that a change to one step leaves the others' draws alone. */
enum { STREAM_SHAPE = 0x5ca1ab1e, STREAM_POSE, STREAM_MATERIAL, STREAM_TEXTURE };

static status check_fov(float fov)
{
    if (fov >= 5 && fov <= 150) return OK;
    return fail(ERROR_USAGE, "a field of view of %g degrees; give 5 to 150", (double)fov);
}

/* Poses the mesh, finishes it and gives it a material; the object takes over the mesh's arrays. */
static status complete(scn_mesh *mesh, const shape_traits *traits, uint64_t seed, uint64_t index, float fov,
                       scn_object *out)
{
    mesh_normalize(mesh);
    rng pose = rng_at(seed, index, STREAM_POSE), material = rng_at(seed, index, STREAM_MATERIAL);
    if (!mesh->failed) pose_object(&pose, mesh, traits, fov);
    status s = mesh_finish(mesh, traits->crease_cosine);
    if (s != OK) return s;
    *out = (scn_object){.vertex_count = mesh->vertex_count,
                        .triangle_count = mesh->triangle_count,
                        .material = material_random(&material, mesh, traits),
                        .shape = traits->name};
    if (!out->material) return fail(ERROR_MEMORY, "no memory for a material");
    out->position = mesh->position;
    out->normal = mesh->normal;
    out->reference = mesh->reference;
    out->triangle = mesh->triangle;
    out->part = mesh->part;
    *mesh = (scn_mesh){0};
    return OK;
}

status scn_object_generate(uint64_t seed, uint64_t index, float fov, scn_object *out)
{
    *out = (scn_object){0};
    status s = check_fov(fov);
    if (s != OK) return s;
    rng r = rng_at(seed, index, STREAM_SHAPE);
    scn_mesh mesh = {0};
    shape_traits traits = {0};
    float kind = rng_uniform(&r);
    if (kind < 0.32f)
        shape_union(&r, &mesh, &traits);
    else if (kind < 0.60f)
        shape_blend(&r, &mesh, &traits);
    else if (kind < 0.75f)
        shape_revolution(&r, &mesh, &traits);
    else if (kind < 0.88f)
        shape_superquadric(&r, &mesh, &traits);
    else
        shape_relief(&r, &mesh, &traits);
    s = complete(&mesh, &traits, seed, index, fov, out);
    mesh_free(&mesh);
    return s;
}

status scn_object_from_mesh(const char *path, uint64_t seed, uint64_t index, float fov, scn_object *out)
{
    *out = (scn_object){0};
    status s = check_fov(fov);
    if (s != OK) return s;
    scn_mesh mesh = {0};
    shape_traits traits = {.name = "mesh", .upright = true, .crease_cosine = 0.6f, .parts = 1};
    s = mesh_read(path, &mesh, &traits.parts);
    if (s == OK) s = complete(&mesh, &traits, seed, index, fov, out);
    mesh_free(&mesh);
    return s == OK ? OK : fail_in(s, "%s", path);
}

void scn_object_wear(scn_object *object, const scn_textures *textures, uint64_t seed, uint64_t index)
{
    rng r = rng_at(seed, index, STREAM_TEXTURE);
    material_wear(object->material, textures, &r);
}

void scn_object_free(scn_object *object)
{
    free(object->position);
    free(object->normal);
    free(object->reference);
    free(object->triangle);
    free(object->part);
    free(object->material);
    *object = (scn_object){0};
}

static vec3 interpolate(const vec3 *value, const uint32_t t[3], real u, real v)
{
    return vec3_fma(vec3_fma(vec3_scale(value[t[0]], 1 - u - v), u, value[t[1]]), v, value[t[2]]);
}

/* The place of a triangle in camera space and in the material's space. */
typedef struct patch {
    vec3 p[2], q[2]; /* edges from the first vertex: posed, reference */
    vec3 cross_p, cross_q;
} patch;

static patch make_patch(const scn_object *o, const uint32_t t[3])
{
    patch e;
    for (int k = 0; k < 2; k++) {
        e.p[k] = vec3_sub(o->position[t[k + 1]], o->position[t[0]]);
        e.q[k] = vec3_sub(o->reference[t[k + 1]], o->reference[t[0]]);
    }
    e.cross_p = vec3_cross(e.p[0], e.p[1]);
    e.cross_q = vec3_cross(e.q[0], e.q[1]);
    return e;
}

/* The surface gradient, in camera space, of the material's height field (after Mikkelsen 2010): the height's change
 * along the two reference edges, carried to the posed edges and scaled as the triangle was. */
static vec3 height_gradient(const scn_object *o, const patch *e, vec3 reference, uint8_t part)
{
    float area_p = vec3_length(e->cross_p), area_q = vec3_length(e->cross_q);
    if (!(area_q > 1e-4f * vec3_dot(e->q[0], e->q[0])) || area_p <= 0) return (vec3){0, 0, 0};
    vec3 facing = vec3_scale(e->cross_q, 1 / area_q), tangent[2] = {vec3_normalize(e->q[0])};
    tangent[1] = vec3_cross(facing, tangent[0]);
    float d[2], along[2], scale = sqrtf(area_p / area_q);
    material_slope(o->material, reference, facing, part, tangent, d);
    for (int k = 0; k < 2; k++)
        along[k] = scale * (d[0] * vec3_dot(tangent[0], e->q[k]) + d[1] * vec3_dot(tangent[1], e->q[k]));
    vec3 n = vec3_scale(e->cross_p, 1 / area_p);
    vec3 g = vec3_fma(vec3_scale(vec3_cross(e->p[1], n), along[0]), along[1], vec3_cross(n, e->p[0]));
    return vec3_scale(g, 1 / area_p);
}

void scn_surface_eval(const scn_object *object, uint32_t triangle, real u, real v, scn_surface *out)
{
    const uint32_t *t = object->triangle[triangle];
    uint8_t part = object->part[triangle];
    patch e = make_patch(object, t);
    vec3 reference = interpolate(object->reference, t, u, v);
    out->position = interpolate(object->position, t, u, v);
    out->geometric_normal = vec3_normalize(e.cross_p);
    material_eval(object->material, reference, vec3_normalize(e.cross_q), part, &out->albedo, &out->roughness);
    vec3 n = vec3_normalize(interpolate(object->normal, t, u, v));
    if (object->material->bumps || object->material->embossed)
        n = vec3_normalize(vec3_sub(n, height_gradient(object, &e, reference, part)));
    float front = vec3_dot(n, out->geometric_normal);
    if (!(front > 0.05f)) /* bent behind the surface: back to where it just faces outward */
        n = vec3_normalize(vec3_fma(n, 0.05f - front, out->geometric_normal));
    if (!(vec3_dot(n, n) > 0.5f)) n = out->geometric_normal;
    out->normal = n;
}
