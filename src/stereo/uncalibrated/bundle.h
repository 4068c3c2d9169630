/* SPDX-License-Identifier: MIT */
/* Estimates a surface and the positions of near lights jointly from the pictures alone ("bundle adjustment"): a depth
 * map on a coarse grid, an albedo per cell and a position per light, by robust nonlinear least squares on all values at
 * once.
 *
 *     bundle b;
 *     status s = bundle_new(p, &camera, 12, &b);
 *     ... b.log_depth and b.position from a start ...
 *     s = bundle_refine(&b, 0.4f, 20);                   widest first
 *     bundle_free(&b);
 *
 * A cell's radiance under light k is  ρ g max(0, n·l) / d²  with a strength g that is 1 for all lights, their power
 * being absorbed by ρ, or an unknown of each (bundle_kind). The unknown of the surface is the logarithm of depth at the
 * cells' corners, so that it is integrable by construction; its mean is 0, and depth is in units of the camera's mean
 * distance. Priors, all small compared with the pictures, determine what near lights hardly do: the lights have about
 * equal distances from the object, and the surface does not bend or twist more than necessary. Distant lights are far
 * near ones. Where a surface and lights are expected from elsewhere, these are priors, too. */
#ifndef MERLIN_STEREO_UNCALIBRATED_BUNDLE_H
#define MERLIN_STEREO_UNCALIBRATED_BUNDLE_H

#include "stereo/fit/problem.h"

typedef struct bundle_cell {
    int corner[4]; /* left above, right above, left below, right below */
    float x, y;    /* the ray of its centre is (x, y, -1) */
    float albedo;  /* albedo of values in radiance times squared distance, with lights of power 1 */
    float level;   /* ordinary value of the cell */
} bundle_cell;

/* Surface and lights that are expected (pst_expected), as a bundle's unknowns. */
typedef struct bundle_expected {
    vec3 *place;   /* per light: its position */
    float *sure;   /* per light: the probability that there is one */
    float *slope;  /* two per cell: of log depth by a ray's x and y */
    float *weight; /* per cell: 0 where no surface is expected, less where it is steep */
} bundle_expected;

/* Kind of the lights: near or distant, and of one strength or of any. Those of two to six pictures by a camera far away
 * are distant: the distances that they have in the bundle, all far, stand for their strengths. */
typedef enum bundle_kind { BUNDLE_NEAR_EQUAL, BUNDLE_NEAR_FREE, BUNDLE_DISTANT_EQUAL, BUNDLE_DISTANT_FREE } bundle_kind;

typedef struct bundle {
    const pst_problem *problem;
    bundle_kind kind;
    pinhole camera;
    int left, top, side;        /* the grid in the pictures, in pixels; side: of a cell */
    int columns, rows;          /* numbers of cells */
    int cells, corners, lights; /* numbers of cells that contain the object, of their corners, and of pictures */
    float step;                 /* step of a ray's x or y from corner to corner */
    float radius;               /* radius of the object's outline in units of depth */
    vec3 centre;                /* centre of the object, at its mean depth */
    bundle_cell *cell;
    int *corner_at;            /* (columns + 1) × (rows + 1): index of the corner, -1 if no cell has it */
    float *value;              /* cells × lights */
    float *precision;          /* cells × lights: 1 / (an ordinary residual)², 0 if there is no value */
    float *log_depth;          /* per corner */
    vec3 *position;            /* per light, in units of depth */
    float *strength;           /* per light */
    bundle_expected *expected; /* NULL: nothing is */
    double cost; /* cost of the last refinement: the sum of each value's share of an outlier, and the priors */
} bundle;

/* Makes the grid. across: number of cells along the longer side of the object. The camera has a
 * perspective. MERLIN_BAD_INPUT if the mask contains too few cells. */
status bundle_new(const pst_problem *p, const pinhole *camera, bundle_kind kind, int across, bundle *out);
/* Distance of distant lights that are as strong as most, in radii of the object. */
#define BUNDLE_AFAR 100.0f
void bundle_free(bundle *b);
bool bundle_is_near(const bundle *b);

/* Returns the depth at a pixel of the pictures in units of the camera's mean distance, inter- and extrapolated from the
 * corners. */
float bundle_depth(const bundle *b, float x, float y);
/* Sets the surface that inflating the object's outline gives (inflate.h), with heights multiplied by relief; below 0: a
 * bowl. */
status bundle_inflate(bundle *b, float relief);

/* Returns a cell's normal, facing the camera. */
vec3 bundle_normal(const bundle *b, int cell);

/* Copies surface and lights from another grid for the same problem; albedos are unchanged. */
void bundle_take(bundle *b, const bundle *from);

/* Fits the cells' albedos to the present surface and lights. */
void bundle_fit_albedo(bundle *b);
/* Fits albedos and free strengths of the lights to the present surface and positions. */
void bundle_fit_strengths(bundle *b);

/* Makes Levenberg-Marquardt steps under Geman and McClure's loss, whose width is in units of a cell's ordinary value,
 * until they gain little or `steps` are made. */
status bundle_refine(bundle *b, float width, int steps);

/* Returns the cost of a light's picture if the light, of its present strength, is at a position; width as for
 * bundle_refine. */
double bundle_light_cost(const bundle *b, int light, vec3 place, float width);

/* Returns the shading of a cell by a light of power 1: cosine over squared distance, below 0 if it faces away. */
float bundle_shading(const bundle *b, int cell, vec3 light);

#endif
