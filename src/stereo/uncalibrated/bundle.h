/* SPDX-License-Identifier: MIT */
/* A surface and the near lights over it found together from the pictures alone ("bundle adjustment"): a depth map on a
 * coarse grid, an albedo a cell and a position a light, by robust nonlinear least squares on all values at once.
 *
 *     bundle b;
 *     status s = bundle_new(p, &camera, 12, &b);
 *     ... b.log_depth and b.position from a start ...
 *     s = bundle_refine(&b, 0.4f, 20);                   widest first
 *     bundle_free(&b);
 *
 * A cell's radiance under light k is  ρ max(0, n·l) / d²  with one power for all lights, absorbed by ρ. The unknown is
 * the logarithm of depth at the cells' corners, so that the surface is integrable by construction; its mean is 0, depth
 * being measured in the camera's mean distance. What near lights leave weakly determined is left to priors, all small
 * beside the pictures: the lights are about equally far from the object, and the surface does not bend or twist more
 * than it must. */
#ifndef MERLIN_STEREO_UNCALIBRATED_BUNDLE_H
#define MERLIN_STEREO_UNCALIBRATED_BUNDLE_H

#include "stereo/fit/problem.h"

typedef struct bundle_cell {
    int corner[4]; /* left above, right above, left below, right below */
    float x, y;    /* its middle's ray is (x, y, -1) */
    float albedo;  /* of values in radiance times squared distance, with lights of power 1 */
    float level;   /* an ordinary value of it */
} bundle_cell;

typedef struct bundle {
    const pst_problem *problem;
    pinhole camera;
    int left, top, side;        /* the grid in the pictures, in pixels; side: of a cell */
    int columns, rows;          /* cells */
    int cells, corners, lights; /* cells that hold the object, their corners, pictures */
    float step;                 /* of a ray's x or y, from corner to corner */
    float radius;               /* of the object's outline in units of depth */
    vec3 centre;                /* of the object, where its mean depth is */
    bundle_cell *cell;
    int *corner_at;   /* (columns + 1) × (rows + 1): number of the corner, -1 for one that no cell has */
    float *value;     /* cells × lights */
    float *precision; /* cells × lights: 1 / (an ordinary residual)², 0 where there is no value */
    float *log_depth; /* corners */
    vec3 *position;   /* lights, in units of depth */
    double cost;      /* of the last refinement, a share of an outlier for each value, priors included */
} bundle;

/* across: cells along the longer side of the object. The camera has a perspective. MERLIN_BAD_INPUT where the mask
 * holds too few cells. */
status bundle_new(const pst_problem *p, const pinhole *camera, int across, bundle *out);
void bundle_free(bundle *b);

/* Depth at a pixel of the pictures, in the camera's mean distance, inter- and extrapolated from the corners. */
float bundle_depth(const bundle *b, float x, float y);
/* The surface that a balloon of the object's outline has (inflate.h), its heights times relief; below 0: a bowl. */
status bundle_inflate(bundle *b, float relief);

/* The surface and lights of another grid over the same problem; albedos stay as they are. */
void bundle_take(bundle *b, const bundle *from);

/* The cells' albedos for the surface and lights as they are. */
void bundle_fit_albedo(bundle *b);

/* Levenberg-Marquardt steps under Geman and McClure's loss, whose width is in ordinary values of a cell, until they
 * gain little or steps are done. */
status bundle_refine(bundle *b, float width, int steps);

/* What a light's picture costs if the light is at a place; width as of bundle_refine. */
double bundle_light_cost(const bundle *b, int light, vec3 place, float width);

/* What a cell sees of a light of power 1: cosine over squared distance, below 0 if turned away. */
float bundle_shading(const bundle *b, int cell, vec3 light);

#endif
