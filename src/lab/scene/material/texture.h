/* SPDX-License-Identifier: MIT */
/* Photographed materials that tile, from a folder: albedo with, where the folder has them, roughness and normal detail.
 *
 *     scene_textures textures;
 *     status s = scene_textures_read("materials", &textures);
 *     scene_object_apply_textures(&object, &textures, seed, index);    the object points into the textures from now on
 *     ...
 *     scene_textures_free(&textures);
 */
#ifndef MERLIN_LAB_SCENE_MATERIAL_TEXTURE_H
#define MERLIN_LAB_SCENE_MATERIAL_TEXTURE_H

#include "base/skipped.h"
#include "image/image.h"
#include "lab/scene/scene.h"
#include "mesh/mesh.h"

/* Each image is one tile, repeated without end; u runs right and v up, both in the tile's widths. */
typedef struct scene_texture {
    img albedo;    /* 3 channels, linear */
    img roughness; /* 1 channel; empty: the paint's own */
    img slope;     /* 2 channels, how steeply the height rises along u and v; empty: flat */
} scene_texture;

typedef struct scene_textures {
    scene_texture *texture;
    size_t count;
    skipped_files skipped; /* pictures of formats that are not read */
} scene_textures;

/* How a texture lies in the material's solid space: on three planes across each other, blended by the surface's
 * direction. */
typedef struct texture_place {
    const scene_texture *texture; /* NULL: none */
    mat3 turn;
    float scale; /* tiles' widths per unit length */
    vec3 offset; /* tiles' widths */
} texture_place;

/* The materials of a folder and of the folders in it. Files that share a name up to a word make one material, as the
 * usual libraries name them: brick_albedo.png (basecolor, color, diffuse), brick_roughness.png (rough),
 * brick_normal.png (nor_gl, normalgl: green is up; nor_dx, normaldx: down). Files called by such a word alone, as in
 * brick/albedo.png, are one material a folder. A picture without such a word is an albedo alone; other maps (height,
 * metalness, ...) are passed over. Tiles are shrunk to at most 512 pixels a side. MERLIN_BAD_INPUT if there is no
 * albedo at all. */
status scene_textures_read(const char *folder, scene_textures *out);
void scene_textures_free(scene_textures *textures);

/* Most objects are given textures for their grounds, chosen and laid by (seed, index); painted regions stay over them.
 * The textures must outlive the object. Call it once. */
void scene_object_apply_textures(scene_object *object, const scene_textures *textures, uint64_t seed, uint64_t index);

/* At a reference point; facing is the reference surface's normal. The texture must have the map asked for. */
vec3 texture_albedo(const texture_place *place, vec3 reference, vec3 facing);
float texture_roughness(const texture_place *place, vec3 reference, vec3 facing);
/* Gradient of the height of the normal detail in reference space: dot it with a unit tangent for the slope that way. */
vec3 texture_gradient(const texture_place *place, vec3 reference, vec3 facing);

#endif
