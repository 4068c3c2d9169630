/* SPDX-License-Identifier: MIT */
/* The steps of a calibration: the ball's circle, its shape, and one light from one picture. */
#ifndef MERLIN_STEREO_CALIBRATE_CALIBRATE_PARTS_H
#define MERLIN_STEREO_CALIBRATE_CALIBRATE_PARTS_H

#include "base/warnings.h"
#include "merlin/calibrate.h"
#include "stereo/capture/capture.h"

/* Finds the circle with the most complete edge in a picture of one channel, outside `beside`, which may be NULL; *found
 * is false if there is none. */
status ball_find(const img *picture, const merlin_circle *beside, merlin_circle *circle, bool *found);

/* Measures the share of a circle along which the picture has an edge. */
status ball_share_seen(const img *picture, const merlin_circle *circle, float *share);

/* Finds a circle around one that was found, along all of which the picture, of logarithms, has a sharp step up or down
 * (calibrate_outline.c); returns false if there is none. */
bool ball_around(const img *picture, const merlin_circle *inner, merlin_circle *outer);
/* Tells whether a circle within it is where a mirror ball of this outline reflects the horizon of its table. */
bool ball_has_horizon(const img *picture, const merlin_circle *circle);
/* Refines the circle to the nearest edges, however strong others are. */
status ball_refine(const img *picture, merlin_circle *circle);

enum { BALL_MOST_OUTLINES = 3 };

/* The outlines that the ball may have, the most likely first: the most complete circle, one around it, one outside. */
typedef struct ball_outlines {
    merlin_circle at[BALL_MOST_OUTLINES];
    int count;
    bool nested;                        /* whether one of the first two contains the other */
    float residual[BALL_MOST_OUTLINES]; /* residuals of a matte ball's shading, once tried; above 1: failed */
    float ratio;                        /* ratio of the inner to the outer radius of nested ones */
} ball_outlines;
/* Lists the outlines. picture: each pixel's brightest value over the pictures; darkest: its darkest, without
 * highlights. */
status ball_list_outlines(const img *picture, const img *darkest, merlin_ball ball, ball_outlines *out);

/* The ball in space, as far as the view determines it. */
typedef struct ball_view {
    merlin_circle circle;
    pinhole camera;
    vec3 center; /* centre of a ball of radius 1, in the space of a near camera */
} ball_view;

/* Finds the centre of the ball whose circle was found in the same picture; camera: near. */
status ball_center(const img *picture, const pinhole *camera, const merlin_circle *circle, vec3 *center);

/* Computes the unit normal of the ball and the unit direction to the camera at a pixel position; returns false outside
 * the ball. */
bool ball_point(const ball_view *view, float x, float y, vec3 *normal, vec3 *to_camera);

/* Finds the light of a mirror ball. picture: 1 channel, linear, without what all pictures share. */
status ball_mirror_light(const img *picture, const ball_view *view, merlin_circle *highlight, vec3 *direction);

/* Finds the light of a matte ball. picture: 1 channel, linear. */
status ball_shading_light(const img *picture, const ball_view *view, float *residual, vec3 *direction);
/* Computes the mean value of a ball's visible part that faces away from a light; returns false if hardly any is
 * visible. */
bool ball_dark_level(const img *picture, const ball_view *view, vec3 light, float *level);

/* Adds warnings about lights that were found: shading_unlike, and about a mask's circle mask_not_round and
 * circle_unsure. mask: the capture's; outlines: each pixel's brightest value, as for ball_find. */
status ball_check(const img *mask, const img *outlines, merlin_calibration *c);

#endif
