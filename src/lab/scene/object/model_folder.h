/* SPDX-License-Identifier: MIT */
/* Meshes of a folder as objects for rendering: each drawn as often as the others, deformed so that a few hundred give
 * hundreds of thousands.
 *
 *     scn_models models;
 *     status s = scn_models_read("meshes", &models);
 *     if (scn_models_chosen(seed, index, 0.5f)) s = scn_object_from_models(&models, seed, index, 60, &object);
 *     scn_models_free(&models);
 */
#ifndef MERLIN_LAB_SCENE_OBJECT_MODEL_FOLDER_H
#define MERLIN_LAB_SCENE_OBJECT_MODEL_FOLDER_H

#include <stdbool.h>

#include "base/skipped.h"
#include "lab/scene/scene.h"

typedef struct scn_models {
    scn_model **at;
    size_t count;
    skipped_files skipped; /* meshes that cannot be read */
} scn_models;

/* The .ply, .obj, .gltf and .glb files of a folder and of those in it; other files are passed over. MERLIN_BAD_INPUT if
 * none can be read. */
status scn_models_read(const char *folder, scn_models *out);
void scn_models_free(scn_models *models);

/* Whether an object is one of them, as is the share of all. */
bool scn_models_chosen(uint64_t seed, uint64_t index, float share);

/* A mesh drawn from (seed, index), a third of them as they are, the others mirrored, stretched, bent, twisted or
 * dented; posed, with a procedural material, as scn_object_from_model does it. */
status scn_object_from_models(const scn_models *models, uint64_t seed, uint64_t index, float fov, scn_object *out);

#endif
