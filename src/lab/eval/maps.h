/* SPDX-License-Identifier: MIT */
/* The four material maps as the metrics take them, and pictures rendered from them.
 *
 *     eval_maps truth;
 *     status s = eval_maps_of_sample(&sample, &truth);
 *     img lit;
 *     if (s == OK) s = eval_render(&truth, &sample.mask, 60, 5.95f, &light, &lit);
 *     eval_maps_free(&truth);
 */
#ifndef MERLIN_LAB_EVAL_MAPS_H
#define MERLIN_LAB_EVAL_MAPS_H

#include "lab/render/sample.h"
#include "optics/light.h"

typedef struct eval_maps {
    img albedo;    /* 3 channels, [-1, 1] as inside the network */
    img normal;    /* 3, unit */
    img roughness; /* 1, [-1, 1] */
    img depth;     /* 1, scene units */
} eval_maps;

/* Sets of them. What each is worth to relighting is in docs/notes/relighting_limits.md. */
enum { EVAL_GIVEN_ALBEDO = 1, EVAL_GIVEN_NORMAL = 2, EVAL_GIVEN_ROUGHNESS = 4, EVAL_GIVEN_DEPTH = 8 };

/* Copies those of the set, which must be of the same size. */
void eval_maps_take(const eval_maps *from, int set, eval_maps *to);

/* Zero-filled. On failure nothing is held. */
status eval_maps_new(eval_maps *out, int width, int height);
void eval_maps_free(eval_maps *maps);
status eval_maps_of_sample(const sample *s, eval_maps *out);
/* An albedo's or a roughness' values from [-1, 1] to [0, 1], as files have them, and back. */
void eval_to_file_range(img *map);
void eval_to_network_range(img *map);
/* Means of normals (3 channels) are shorter than 1. */
void eval_make_unit(img *normal);

/* The object under a light, without shadows: optics/light.h at every pixel, clipped to [0, 1], and what the diffuse
 * surface reflects of the surroundings; clipped, times the mask. fov in degrees, power is Φ. out is made here. */
status eval_render(const eval_maps *maps, const img *mask, float fov, float power, const illumination *light, img *out);

/* 1 where the coverage is above EVAL_MASK_LEVEL, else 0: the mask that the network is trained with. Made here. */
status eval_binary_mask(const img *coverage, img *out);

/* A picture: a + b clipped to [0, 1], zero outside the mask; b may be NULL. Made here, 3 channels. */
status eval_picture(const img *a, const img *b, const img *mask, img *out);
/* The same, clipped to [0, white]. */
status eval_photograph(const img *a, const img *b, const img *mask, float white, img *out);

/* The sample's target light number i, drawn from its seed and index: the same in every evaluation. */
vec3 eval_light(const sample *s, int i);

#endif
