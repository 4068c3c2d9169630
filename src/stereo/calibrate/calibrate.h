/* SPDX-License-Identifier: MIT */
/* Light directions from pictures of a ball: where lights mirror in a chrome one, or how they shade a matte one.
 *
 *     pst_calibration c;
 *     status s = pst_calibrate_sphere("ball", &(pst_calibrate_options){.ball = MERLIN_CHROME_BALL}, &c);
 *     if (s == OK) s = pst_calibration_write(&c, "ball/lights.txt", "ball/calibration.png");
 *     pst_calibration_free(&c);
 *
 * The lights count as distant: one direction for the whole scene. */
#ifndef MERLIN_STEREO_CALIBRATE_CALIBRATE_H
#define MERLIN_STEREO_CALIBRATE_CALIBRATE_H

#include "base/watch.h"
#include "stereo/calibrate/calibration.h"

typedef struct pst_calibrate_options {
    pst_ball ball;
    const char *mask;    /* of the ball; NULL: the folder's mask.png or the like, else the ball is searched for */
    float field_of_view; /* of the camera, horizontal, degrees; 0: an orthographic view */
    const watch *watch;  /* may be NULL */
    bool linear;         /* 8-bit pictures are linear already */
} pst_calibrate_options;

/* MERLIN_BAD_INPUT with one clear line if the ball, or the light in a picture of it, is not found. */
status pst_calibrate_sphere(const char *folder, const pst_calibrate_options *options, pst_calibration *out);
/* lights: a direction a line, which pst_capture_read finds by the name of lights.txt; picture: a PNG of circle,
 * highlights and arrows to the lights. */
status pst_calibration_write(const pst_calibration *c, const char *lights, const char *picture);

#endif
