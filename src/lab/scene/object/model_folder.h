/* SPDX-License-Identifier: MIT */
/* Meshes of a folder as objects for rendering: chosen with equal probability and deformed, so that a few hundred give
 * hundreds of thousands of objects.
 *
 *     scene_models models;
 *     status s = scene_models_read("meshes", &models);
 *     if (scene_models_chosen(seed, index, 0.5f)) s = scene_object_from_models(&models, seed, index, 60, &object);
 *     scene_models_free(&models);
 */
#ifndef MERLIN_LAB_SCENE_OBJECT_MODEL_FOLDER_H
#define MERLIN_LAB_SCENE_OBJECT_MODEL_FOLDER_H

#include <stdbool.h>

#include "base/skipped.h"
#include "lab/scene/scene.h"

typedef struct scene_models {
    scene_model **at;
    size_t count;
    skipped_files skipped; /* meshes that cannot be read */
} scene_models;

/* Reads the .ply, .obj, .gltf and .glb files of a folder and its sub-folders; other files are skipped. MERLIN_BAD_INPUT
 * if none can be read. */
status scene_models_read(const char *folder, scene_models *out);
void scene_models_free(scene_models *models);

/* Tells whether an object is one of these meshes, which holds for the share `share` of all. */
bool scene_models_chosen(uint64_t seed, uint64_t index, float share);

/* Makes an object from a mesh chosen by (seed, index): a third of them unchanged, the others mirrored, stretched, bent,
 * twisted or dented; posed, with a procedural material, as by scene_object_from_model. */
status scene_object_from_models(const scene_models *models, uint64_t seed, uint64_t index, float fov,
                                scene_object *out);

#endif
