/* SPDX-License-Identifier: MIT */
/* The lights that a ball tells of, and the ball. */
#ifndef MERLIN_STEREO_CALIBRATE_CALIBRATION_H
#define MERLIN_STEREO_CALIBRATE_CALIBRATION_H

#include <stdbool.h>

#include "base/skipped.h"
#include "base/vec.h"
#include "base/warnings.h"
#include "image/image.h"

typedef enum pst_ball { MERLIN_CHROME_BALL, MERLIN_MATTE_BALL } pst_ball;

/* Pixels from the top left corner; a pixel's centre is at one half. */
typedef struct pst_circle {
    float x, y, radius;
} pst_circle;

typedef struct pst_calibration {
    pst_ball ball;
    pst_circle circle;
    bool from_mask;        /* the circle was fitted to a mask's edge */
    int count;             /* pictures */
    char **name;           /* their file names, sorted */
    vec3 *direction;       /* unit, to the light */
    pst_circle *highlight; /* chrome: centre of each highlight, radius of a disk of its area; NULL for matte */
    float *residual;       /* matte: root mean square over the pixels used, relative to the light; NULL for chrome */
    warnings doubts;       /* circle_unsure, mask_not_round, shading_unlike, lights_behind, same_pictures */
    skipped_files skipped; /* of the folder */
    img brightest;         /* 3 channels, linear: the pixelwise maximum, which calibration.png shows */
} pst_calibration;

void pst_calibration_free(pst_calibration *c);

#endif
