/* Light directions from pictures of a ball: where lights mirror in a chrome one, or how they shade a matte one.
 *
 *     pst_calibration c;
 *     status s = pst_calibrate_sphere("ball", &(pst_calibrate_options){.ball = PST_CHROME}, &c);
 *     if (s == OK) s = pst_calibration_write(&c, "ball/lights.txt", "ball/calibration.png");
 *     pst_calibration_free(&c);
 *
 * The lights count as distant: one direction for the whole scene. */
#ifndef MERLIN_STEREO_CALIBRATE_H
#define MERLIN_STEREO_CALIBRATE_H

#include "base/warnings.h"
#include "stereo/capture.h"

typedef enum pst_ball { PST_CHROME, PST_MATTE } pst_ball;

typedef struct pst_calibrate_options {
    pst_ball ball;
    const char *mask;    /* of the ball; NULL: the folder's mask.png or the like, else the ball is searched for */
    float field_of_view; /* of the camera, horizontal, degrees; 0: an orthographic view */
    const watch *watch;  /* may be NULL */
    bool linear;         /* 8-bit pictures are linear already */
} pst_calibrate_options;

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

/* ERROR_INPUT with one clear line if the ball, or the light in a picture of it, is not found. */
status pst_calibrate_sphere(const char *folder, const pst_calibrate_options *options, pst_calibration *out);
/* The first words of the list that is written, by which it is known again. */
#define PST_CALIBRATION_LIST "# Directions to the lights, found from"
/* lights: a direction a line, which pst_capture_read finds by the name of lights.txt; picture: a PNG of circle,
 * highlights and arrows to the lights. */
status pst_calibration_write(const pst_calibration *c, const char *lights, const char *picture);
void pst_calibration_free(pst_calibration *c);

#endif
