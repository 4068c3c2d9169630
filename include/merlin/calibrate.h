/* SPDX-License-Identifier: MIT */
/* merlin/calibrate: directions of lights from pictures of a ball, one picture per light. A mirror ball shows them by
 * its highlight, a matte one by its shading.
 *
 *     merlin_calibration found;
 *     const merlin_calibrate_params mirror = {.ball = MERLIN_CHROME_BALL};
 *     if (merlin_calibrate("ball", &mirror, &found) || merlin_calibration_write(&found, "lights", NULL))
 *         fprintf(stderr, "%s\n", merlin_error());
 *
 * The lights count as distant, with one direction for the whole scene. They are what merlin_capture_add takes, in the
 * order of the pictures' names; merlin_capture_read finds lights.txt if it is in the same folder as the object's
 * pictures. */
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
    const char *mask; /* path of a picture, white on the ball; NULL: the folder's mask.png or similar, else the ball is
                       * searched for */
    int linear;       /* 1: 8-bit pictures are linear, not sRGB */
    float field_of_view; /* horizontal field of view of the camera in degrees, at most 170; 0: that of the first
                          * picture's EXIF, else the camera is far away */
    int (*stop)(void);   /* called between pictures; a nonzero result ends the work with MERLIN_STOPPED; may be NULL */
    merlin_progress progress; /* called for the pictures that are read, with "reading"; may be NULL */
    void *progress_context;
} merlin_calibrate_params;

/* A circle in pixels from the upper left corner; a pixel's centre is at one half. */
typedef struct merlin_circle {
    float x, y, radius;
} merlin_circle;

typedef struct merlin_calibration {
    merlin_ball ball;
    merlin_circle circle; /* outline of the ball */
    int from_mask;        /* 1 if the circle was fitted to a mask's edge */
    char *mask_file;      /* path of the mask; NULL: none was read */
    int count;
    char **names;         /* count names of the pictures' files, sorted */
    merlin_light *lights; /* count lights: `direction`, unit, to the light; their intensities are 0, 0, 0: unknown */
    merlin_circle *highlights; /* count, for a mirror ball: centres of highlights, and radii of discs of their areas */
    float *residuals; /* count residuals, for a matte ball: root mean square of what its shading does not explain, as a
                       * share of the light */
    merlin_warnings warnings;     /* circle_unsure, mask_not_round, shading_unlike, lights_behind, same_pictures */
    merlin_skipped_files skipped; /* files of the folder that were not used */
    merlin_image brightest;       /* brightest value of each pixel, 3 channels, linear; calibration.png shows it */
} merlin_calibration;

/* Finds ball and lights. MERLIN_BAD_INPUT if the ball, or a picture's light, is not found or cannot be read. */
merlin_status merlin_calibrate(const char *folder, const merlin_calibrate_params *params, merlin_calibration *out);
void merlin_calibration_free(merlin_calibration *calibration);

/* Writes lights.txt (x y z a line) and calibration.png, with the circle, highlights and arrows to the lights, into a
 * folder, which is created if necessary: both or, after a failure, none. written (may be NULL) gets their paths. */
merlin_status merlin_calibration_write(const merlin_calibration *calibration, const char *folder,
                                       merlin_files *written);

#ifdef __cplusplus
}
#endif

#endif
