/* SPDX-License-Identifier: MIT */
/* merlin/calibrate: the directions of lights from pictures of a ball, one picture a light: by the highlight on a mirror
 * ball, by the shading of a matte one.
 *
 *     merlin_calibration found;
 *     const merlin_calibrate_params mirror = {.ball = MERLIN_CHROME_BALL};
 *
 *     if (merlin_calibrate("ball", &mirror, &found) || merlin_calibration_write(&found, "lights", NULL))
 *         fprintf(stderr, "%s\n", merlin_error());
 *
 * The lights count as distant: one direction for the whole scene. They are what merlin_capture_add takes, in the order
 * of the pictures' names; merlin_capture_read finds lights/lights.txt where it lies beside the object's pictures. */
#ifndef MERLIN_CALIBRATE_H
#define MERLIN_CALIBRATE_H

#include <merlin/files.h>
#include <merlin/image.h>
#include <merlin/stereo.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum merlin_ball { MERLIN_CHROME_BALL, MERLIN_MATTE_BALL } merlin_ball;

typedef struct merlin_calibrate_params {
    merlin_ball ball;
    const char *mask;    /* a picture, white on the ball; NULL: the folder's mask.png or the like, else the ball is
                          * searched for */
    int linear;          /* 1: 8-bit pictures are linear, not sRGB */
    float field_of_view; /* of the camera, horizontal, degrees, at most 170; 0: it is far away */
    int (*stop)(void);   /* asked between pictures; returning nonzero ends the work with MERLIN_STOPPED; may be NULL */
    merlin_progress progress; /* told of the pictures that are read, "reading"; may be NULL */
    void *progress_context;
} merlin_calibrate_params;

/* Pixels from the upper left corner; a pixel's centre is at one half. */
typedef struct merlin_circle {
    float x, y, radius;
} merlin_circle;

typedef struct merlin_calibration {
    merlin_ball ball;
    merlin_circle circle; /* the ball's outline */
    int from_mask;        /* 1: the circle was fitted to a mask's edge */
    char *mask_file;      /* the mask's; NULL: none was read */
    int count;
    char **names;              /* count names of the pictures' files, sorted */
    merlin_light *lights;      /* count: `direction`, unit, to the light; their intensities are 0, 0, 0: not known */
    merlin_circle *highlights; /* count, of a mirror ball: a highlight's centre, the radius of a disc of its area */
    float *residuals;          /* count, of a matte ball: root mean square of what its shading leaves unexplained, as a
                                * share of the light */
    merlin_warnings warnings;  /* circle_unsure, mask_not_round, shading_unlike, lights_behind, same_pictures */
    merlin_skipped_files skipped; /* of the folder */
    merlin_image brightest;       /* 3 channels, linear: the brightest of each pixel, which calibration.png shows */
} merlin_calibration;

/* MERLIN_BAD_INPUT if the ball, or the light in a picture of it, is not found, and for pictures that cannot be read. */
merlin_status merlin_calibrate(const char *folder, const merlin_calibrate_params *params, merlin_calibration *out);
void merlin_calibration_free(merlin_calibration *calibration);

/* Writes lights.txt (x y z a line) and calibration.png, the circle, highlights and arrows to the lights, into a folder,
 * which is made if need be: both or, after a failure, none. written (may be NULL) gets their paths. */
merlin_status merlin_calibration_write(const merlin_calibration *calibration, const char *folder,
                                       merlin_files *written);

#ifdef __cplusplus
}
#endif

#endif
