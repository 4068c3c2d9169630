/* SPDX-License-Identifier: MIT */
#include "lab/scene/object/model_folder.h"

#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/rng.h"

/* Random stream, distinct from those of other steps. */
enum { STREAM_CHOICE = 0x5ca1ab40 };

static status read_one(const char *path, const char *folder, scene_models *out)
{
    status s = scene_model_read(path, &out->at[out->count]);
    if (s == OK) {
        out->count++;
        return OK;
    }
    if (s == MERLIN_NO_MEMORY) return s;
    const char *inside = path + strlen(folder), *why = strrchr(status_message(), ':');
    return skipped_add(&out->skipped, inside + strspn(inside, "/"), why ? why + 2 : status_message());
}

status scene_models_read(const char *folder, scene_models *out)
{
    static const char *const endings[] = {".ply", ".obj", ".gltf", ".glb", NULL};
    char **names;
    size_t count;
    *out = (scene_models){0};
    status s = file_list_deep(folder, endings, &names, &count);
    if (s != OK) return s;
    out->at = calloc(count + 1, sizeof *out->at);
    if (!out->at) s = fail(MERLIN_NO_MEMORY, "no memory for the meshes of %s", folder);
    for (size_t i = 0; s == OK && i < count; i++)
        s = read_one(names[i], folder, out);
    if (s == OK && out->count == 0)
        s = fail(MERLIN_BAD_INPUT, "%s holds no meshes that can be read (.ply, .obj, .gltf, .glb)", folder);
    file_list_free(names, count);
    if (s != OK) scene_models_free(out);
    return s;
}

void scene_models_free(scene_models *models)
{
    for (size_t i = 0; i < models->count; i++)
        scene_model_free(models->at[i]);
    free(models->at);
    skipped_free(&models->skipped);
    *models = (scene_models){0};
}

bool scene_models_chosen(uint64_t seed, uint64_t index, float share)
{
    rng r = rng_at(seed, index, STREAM_CHOICE);
    return rng_uniform(&r) < share;
}

status scene_object_from_models(const scene_models *models, uint64_t seed, uint64_t index, float fov, scene_object *out)
{
    rng r = rng_at(seed, index, STREAM_CHOICE + 1);
    const scene_model *model = models->at[rng_below(&r, (int)models->count)];
    return scene_object_from_deformed(model, seed, index, fov, out);
}
