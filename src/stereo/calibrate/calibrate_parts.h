/* SPDX-License-Identifier: MIT */
/* The steps of a calibration: the ball's circle, its shape, and one light from one picture. */
#ifndef MERLIN_STEREO_CALIBRATE_CALIBRATE_PARTS_H
#define MERLIN_STEREO_CALIBRATE_CALIBRATE_PARTS_H

#include "base/warnings.h"
#include "merlin/calibrate.h"
#include "stereo/capture/capture.h"

/* The circle whose edge is seen most completely in a picture of one channel, beside another or NULL; false if there is
 * none. */
status ball_find(const img *picture, const merlin_circle *beside, merlin_circle *circle, bool *found);

/* Measures the share of a circle along which the picture has an edge. */
status ball_share_seen(const img *picture, const merlin_circle *circle, float *share);

/* A circle around one that was found, all along which the picture, of logarithms, steps sharply up or down
 * (calibrate_outline.c); false if there is none. */
bool ball_around(const img *picture, const merlin_circle *inner, merlin_circle *outer);
/* Tells whether a circle within it is where a mirror ball of this outline has the horizon of what it lies on. */
bool ball_has_horizon(const img *picture, const merlin_circle *circle);
/* To the edges that lie nearest, however strong others are. */
status ball_refine(const img *picture, merlin_circle *circle);

enum { BALL_MOST_OUTLINES = 3 };

/* The outlines that the ball may have, the likeliest first: the circle that is seen best, one around it, one beside. */
typedef struct ball_outlines {
    merlin_circle at[BALL_MOST_OUTLINES];
    int count;
    bool nested;                        /* the first and the second are one within the other */
    float residual[BALL_MOST_OUTLINES]; /* of a matte ball's shading, once it is tried; above 1: it has none */
    float ratio;                        /* of nested ones' radii, the lesser against the larger */
} ball_outlines;
/* picture: of the brightest that each pixel is, darkest: of the darkest, without highlights. */
status ball_list_outlines(const img *picture, const img *darkest, merlin_ball ball, ball_outlines *out);

/* The ball in space, as much as the view tells. */
typedef struct ball_view {
    merlin_circle circle;
    pinhole camera;
    vec3 center; /* of a ball of radius 1, in the space of a camera that is near */
} ball_view;

/* The center of the ball that a circle was found of, from the same picture; camera: near. */
status ball_center(const img *picture, const pinhole *camera, const merlin_circle *circle, vec3 *center);

/* The unit normal of the ball and the unit direction to the camera at a pixel position; false beside the ball. */
bool ball_point(const ball_view *view, float x, float y, vec3 *normal, vec3 *to_camera);

/* picture: 1 channel, linear, what all pictures share subtracted. */
status ball_mirror_light(const img *picture, const ball_view *view, merlin_circle *highlight, vec3 *direction);

/* picture: 1 channel, linear. */
status ball_shading_light(const img *picture, const ball_view *view, float *residual, vec3 *direction);
/* The mean of what a ball shows where it faces away from a light; false where that is hardly seen. */
bool ball_dark_level(const img *picture, const ball_view *view, vec3 light, float *level);

/* Adds what is to be doubted of lights that were found: shading_unlike, and of a mask's circle mask_not_round and
 * circle_unsure. mask: as the capture has it; outlines: of the brightest that each pixel is, as ball_find takes it. */
status ball_check(const img *mask, const img *outlines, merlin_calibration *c);

#endif
