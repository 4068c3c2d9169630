/* SPDX-License-Identifier: MIT */
/* Assembles objects: shape, pose, material. */
#include <stdlib.h>
#include <string.h>

#include "lab/scene/material/material.h"
#include "lab/scene/object/pose.h"
#include "lab/scene/scene.h"
#include "lab/scene/shape/mesh_deform.h"
#include "mesh/read/mesh_read.h"

/* Random streams, separate so that a change to one step leaves the numbers of the others alone. */
enum { STREAM_SHAPE = 0x5ca1ab1e, STREAM_POSE, STREAM_MATERIAL, STREAM_TEXTURE, STREAM_DEFORM };

static status check_fov(float fov)
{
    if (fov >= 5 && fov <= 150) return OK;
    return fail(MERLIN_WRONG_USE, "a field of view of %g degrees; give 5 to 150", (double)fov);
}

/* Poses the mesh, finishes it and gives it a material; the object takes over the mesh's arrays. */
static status complete(triangle_mesh *mesh, const shape_traits *traits, uint64_t seed, uint64_t index, float fov,
                       scene_object *out)
{
    if (!mesh->failed) mesh_normalize(mesh);
    rng pose = rng_at(seed, index, STREAM_POSE), material = rng_at(seed, index, STREAM_MATERIAL);
    if (!mesh->failed) pose_object(&pose, mesh, traits, fov);
    status s = mesh_finish(mesh, traits->crease_cosine);
    if (s != OK) return s;
    *out = (scene_object){.vertex_count = mesh->vertex_count,
                          .triangle_count = mesh->triangle_count,
                          .material = material_random(&material, mesh, traits),
                          .shape = traits->name};
    if (!out->material) return fail(MERLIN_NO_MEMORY, "no memory for a material");
    out->position = mesh->position;
    out->normal = mesh->normal;
    out->reference = mesh->reference;
    out->triangle = mesh->triangle;
    out->part = mesh->part;
    *mesh = (triangle_mesh){0};
    return OK;
}

status scene_object_generate(uint64_t seed, uint64_t index, float fov, scene_object *out)
{
    *out = (scene_object){0};
    status s = check_fov(fov);
    if (s != OK) return s;
    rng r = rng_at(seed, index, STREAM_SHAPE);
    triangle_mesh mesh = {0};
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

struct scene_model {
    triangle_mesh mesh;
    int parts;
    char *path;
};

status scene_model_read(const char *path, scene_model **out)
{
    scene_model *m = calloc(1, sizeof *m);
    *out = NULL;
    if (!m || !(m->path = strdup(path))) {
        free(m);
        return fail(MERLIN_NO_MEMORY, "no memory for the mesh %s", path);
    }
    status s = mesh_read(path, &m->mesh, &m->parts);
    if (s != OK) {
        scene_model_free(m);
        return fail_in(s, "%s", path);
    }
    *out = m;
    return OK;
}

void scene_model_free(scene_model *model)
{
    if (!model) return;
    mesh_free(&model->mesh);
    free(model->path);
    free(model);
}

status scene_object_from_model(const scene_model *model, uint64_t seed, uint64_t index, float fov, scene_object *out)
{
    *out = (scene_object){0};
    status s = check_fov(fov);
    if (s != OK) return s;
    triangle_mesh mesh;
    const shape_traits traits = {.name = "mesh", .upright = true, .crease_cosine = 0.6f, .parts = model->parts};
    mesh_copy(&model->mesh, &mesh);
    s = complete(&mesh, &traits, seed, index, fov, out);
    mesh_free(&mesh);
    return s == OK ? OK : fail_in(s, "%s", model->path);
}

status scene_object_from_deformed(const scene_model *model, uint64_t seed, uint64_t index, float fov, scene_object *out)
{
    *out = (scene_object){0};
    status s = check_fov(fov);
    if (s != OK) return s;
    rng r = rng_at(seed, index, STREAM_DEFORM);
    triangle_mesh mesh;
    shape_traits traits = {.name = "mesh", .upright = true, .parts = model->parts};
    traits.crease_cosine = rng_range(&r, 0.3f, 0.85f);
    mesh_copy(&model->mesh, &mesh);
    if (!mesh.failed) mesh_deform(&r, &mesh);
    s = complete(&mesh, &traits, seed, index, fov, out);
    mesh_free(&mesh);
    return s == OK ? OK : fail_in(s, "%s", model->path);
}

void scene_object_apply_textures(scene_object *object, const scene_textures *textures, uint64_t seed, uint64_t index)
{
    rng r = rng_at(seed, index, STREAM_TEXTURE);
    material_apply_textures(object->material, textures, &r);
}

void scene_object_free(scene_object *object)
{
    free(object->position);
    free(object->normal);
    free(object->reference);
    free(object->triangle);
    free(object->part);
    free(object->material);
    *object = (scene_object){0};
}
