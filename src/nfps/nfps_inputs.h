/* SPDX-License-Identifier: MIT */
/* The inputs of the network of near lights (nfps.h) as numbers, which need no graph.
 *
 *     nfps_scene scene = {.pixels = n, .pictures = k, .mask = mask, .point = point, .view = view, .light = light};
 *     const nfps_arrays in = {nn_input_data(p, "picture"), nn_input_data(p, "light"), nn_input_data(p, "matte")};
 *     nfps_encode(&scene, images, workspace, &in);
 *     nfps_turn_all(&scene, normals, nn_input_data(p, "normal"));
 *     ... nfps_turn_back_all(&scene, nn_output_data(p, "normal"), normals); */
#ifndef MERLIN_NFPS_NFPS_INPUTS_H
#define MERLIN_NFPS_NFPS_INPUTS_H

#include "nfps/nfps_scene.h"

/* Where the inputs go: NFPS_PICTURE and NFPS_LIGHT values a pixel of each picture, NFPS_MATTE of the object. */
typedef struct nfps_arrays {
    float *picture, *light, *matte;
} nfps_arrays;

/* Returns the direction from a point to a light, unit, and the light's strength there: an LED's share (optics/led.h)
 * over the squared distance; 1 of a distant light. */
vec3 nfps_light_at(const nfps_light *light, vec3 point, float *strength);

/* Turns a vector by the smallest rotation that takes the unit vector `view` (z > -1) to (0, 0, 1), and back. */
vec3 nfps_turn(vec3 view, vec3 v);
vec3 nfps_turn_back(vec3 view, vec3 v);
/* Turn normals, 3 a pixel; zero outside the mask. In place is allowed. */
void nfps_turn_all(const nfps_scene *scene, const float *normal, float *turned);
void nfps_turn_back_all(const nfps_scene *scene, const float *turned, float *normal);

/* Fills in the inputs "picture" and "light" of all pictures and the object's "matte", zero outside the mask. images:
 * linear light, 3 a pixel, one picture behind another, of lights of one strength (a picture of a stronger light is
 * divided by its strength before). Each is divided by the light's strength at each pixel, relative to its mean, and by
 * the mean of all of that, then encoded as a square root; beside it stands the sum of the channels over its own root
 * mean square in all pictures. "light" is the direction to the light, turned as normals are, and half of the logarithm
 * of that relative strength. "matte" is the normal, turned, of the matte surface that fits each pixel by itself
 * (nfps_matte.h), and what that leaves unexplained. workspace: `pictures` × `pixels` floats; at most NN_LARGEST_GROUP
 * pictures. */
void nfps_encode(const nfps_scene *scene, const float *images, float *workspace, const nfps_arrays *out);

#endif
