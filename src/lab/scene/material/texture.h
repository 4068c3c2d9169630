/* SPDX-License-Identifier: MIT */
/* Photographed materials that tile, from a folder: albedo and, if the folder has them, roughness and normal detail.
 *
 *     scene_textures textures;
 *     status s = scene_textures_read("materials", &textures);
 *     scene_object_apply_textures(&object, &textures, seed, index);    the object then points into the textures
 *     ...
 *     scene_textures_free(&textures);
 */
#ifndef MERLIN_LAB_SCENE_MATERIAL_TEXTURE_H
#define MERLIN_LAB_SCENE_MATERIAL_TEXTURE_H

#include "base/skipped.h"
#include "image/image.h"
#include "lab/scene/scene.h"
#include "mesh/mesh.h"

/* Images of one tile, which repeats indefinitely; u runs right and v up, both in tile widths. */
typedef struct scene_texture {
    img albedo;    /* 3 channels, linear */
    img roughness; /* 1 channel; empty: the paint's own roughness */
    img slope;     /* 2 channels, slope of the height along u and v; empty: flat */
} scene_texture;

typedef struct scene_textures {
    scene_texture *texture;
    size_t count;
    skipped_files skipped; /* pictures in formats that are not read */
} scene_textures;

/* Placement of a texture in the material's solid space: on three perpendicular planes, blended by the surface's
 * direction (triplanar mapping). */
typedef struct texture_place {
    const scene_texture *texture; /* NULL: none */
    mat3 turn;
    float scale; /* tile widths per unit length */
    vec3 offset; /* tile widths */
} texture_place;

/* Reads the materials of a folder and its sub-folders. Files that share a name up to a keyword make one material, as in
 * the usual libraries: brick_albedo.png (basecolor, color, diffuse), brick_roughness.png (rough), brick_normal.png
 * (nor_gl, normalgl: green is up; nor_dx, normaldx: down). Files named by a keyword alone, as brick/albedo.png, make
 * one material a folder. A picture without a keyword is an albedo; other maps (height, metalness, ...) are skipped.
 * Tiles are shrunk to at most 512 pixels a side. MERLIN_BAD_INPUT if there is no albedo at all. */
status scene_textures_read(const char *folder, scene_textures *out);
void scene_textures_free(scene_textures *textures);

/* Gives most objects textures for their base layers, chosen and placed by (seed, index); painted regions stay on top.
 * The textures must outlive the object. To be called once. */
void scene_object_apply_textures(scene_object *object, const scene_textures *textures, uint64_t seed, uint64_t index);

/* Evaluate a texture at a reference point; facing is the reference surface's normal. The texture must have that map. */
vec3 texture_albedo(const texture_place *place, vec3 reference, vec3 facing);
float texture_roughness(const texture_place *place, vec3 reference, vec3 facing);
/* Returns the gradient of the normal detail's height in reference space; its dot product with a unit tangent is the
 * slope in that direction. */
vec3 texture_gradient(const texture_place *place, vec3 reference, vec3 facing);

#endif
