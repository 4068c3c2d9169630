/* SPDX-License-Identifier: MIT */
/* The inputs of the network of near lights (nfps.h) as numbers, which need no graph.
 *
 *     nfps_scene scene = {.pixels = n, .pictures = k, .mask = mask, .point = point, .view = view, .light = light};
 *     nfps_encode(&scene, images, nn_input_data(p, "picture"), nn_input_data(p, "light"));
 *     nfps_turn_all(&scene, normals, nn_input_data(p, "normal"));
 *     ... nfps_turn_back_all(&scene, nn_output_data(p, "normal"), normals); */
#ifndef MERLIN_MODEL_NFPS_NFPS_INPUTS_H
#define MERLIN_MODEL_NFPS_NFPS_INPUTS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/vec.h"

/* A light of a picture, in the space and the unit of the surface's points. */
typedef struct nfps_light {
    vec3 at;      /* position; of a distant light the unit direction toward it */
    bool distant; /* its light is parallel, and as bright everywhere */
    vec3 axis;    /* unit axis of an LED; zero: it shines alike in all directions */
    float lobe;   /* exponent of its fall-off with the cosine of the angle to the axis */
} nfps_light;

/* An object's surface as it is known so far, and its lights. Arrays are by pixel. */
typedef struct nfps_scene {
    size_t pixels;
    int pictures;
    const float *mask;       /* above one half on the object */
    const float *point;      /* 3: the surface's point */
    const float *view;       /* 3: unit direction from there to the eye, z > 0 */
    const nfps_light *light; /* one a picture */
    bool estimated;          /* the lights are estimates, off by several degrees */
} nfps_scene;

/* Returns the direction from a point to a light, unit, and the light's strength there: an LED's share (optics/led.h)
 * over the squared distance; 1 of a distant light. */
vec3 nfps_light_at(const nfps_light *light, vec3 point, float *strength);

/* Turns a vector by the smallest rotation that takes the unit vector `view` (z > -1) to (0, 0, 1), and back. */
vec3 nfps_turn(vec3 view, vec3 v);
vec3 nfps_turn_back(vec3 view, vec3 v);
/* Turn normals, 3 a pixel; zero outside the mask. In place is allowed. */
void nfps_turn_all(const nfps_scene *scene, const float *normal, float *turned);
void nfps_turn_back_all(const nfps_scene *scene, const float *turned, float *normal);

/* Fills in the inputs "picture" and "light" of all pictures, zero outside the mask. images: linear light, 3 a pixel,
 * one picture behind another, of lights of one strength (a picture of a stronger light is divided by its strength
 * before). Each is divided by the light's strength at each pixel, relative to its mean, and by the mean of all of that,
 * then encoded as a square root; beside it stands the sum of the channels over its own root mean square in all
 * pictures. "light" is the direction to the light, turned as normals are, and half of the logarithm of that relative
 * strength. workspace: `pictures` × `pixels` floats. */
void nfps_encode(const nfps_scene *scene, const float *images, float *workspace, float *picture, float *light);

#endif
