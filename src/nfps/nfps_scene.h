/* SPDX-License-Identifier: MIT */
/* The scene of the network of near lights: a surface as far as it is known, and its lights. */
#ifndef MERLIN_NFPS_NFPS_SCENE_H
#define MERLIN_NFPS_NFPS_SCENE_H

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

#endif
