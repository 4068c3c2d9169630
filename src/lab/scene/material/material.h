/* SPDX-License-Identifier: MIT */
/* A procedural svBRDF: layers of paint, each where its mask says, and normal detail finer than the mesh. */
#ifndef MERLIN_LAB_SCENE_MATERIAL_MATERIAL_H
#define MERLIN_LAB_SCENE_MATERIAL_MATERIAL_H

#include "lab/scene/material/pattern.h"
#include "lab/scene/material/texture.h"
#include "lab/scene/scene.h"
#include "lab/scene/shape/shape.h"

/* A paint: up to three colours mixed by a pattern, and a roughness that may follow it. */
typedef struct material_paint {
    int colours;
    vec3 colour[3];
    pattern mix;                /* used with two or three colours, or if roughness varies */
    float roughness, spread;    /* value at the middle of the mix; difference over its whole range */
    texture_place photographed; /* replaces the colours, and the roughness if it has a map of it */
} material_paint;

typedef struct material_layer {
    uint32_t parts;  /* bit i: the layer lies on part i (modulo 32) */
    bool everywhere; /* no mask */
    pattern mask;
    float opacity;
    material_paint paint;
} material_layer;

/* Normal detail: height x pattern above the surface, in units of the object's radius. */
typedef struct material_bump {
    uint32_t parts;
    pattern pattern;
    float height, step; /* step: distance of the finite differences, well below the size of a feature */
} material_bump;

enum { LAYERS = 10, BUMPS = 3 };

struct scene_material {
    int layers, bumps;
    material_layer layer[LAYERS];
    material_bump bump[BUMPS];
    bool embossed; /* a photographed base has normal detail */
    bool smudged;  /* roughness varies independently */
    pattern smudge;
    float smudge_amount;
};

/* Returns a random material for this mesh (its parts and references). NULL if memory ran out. */
scene_material *material_random(rng *r, const triangle_mesh *mesh, const shape_traits *traits);

/* Applies photographed textures to some of the material's base layers, or to none. They must outlive it. */
void material_apply_textures(scene_material *material, const scene_textures *textures, rng *r);

/* Points at which a material is evaluated. */
typedef struct material_points {
    lane_set wanted;
    lanes reference, facing; /* facing: the reference surface's normal */
    uint8_t part[LANES];
} material_points;

void material_eval(const scene_material *material, const material_points *at, lanes *albedo, float roughness[LANES]);

/* Computes d[0] and d[1], the differences of the normal detail's height a unit length along two unit tangents. */
void material_slope(const scene_material *material, const material_points *at, const lanes tangent[2],
                    float d[2][LANES]);

#endif
