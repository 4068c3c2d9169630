/* SPDX-License-Identifier: MIT */
/* Camera simulation for training: from radiance to the encoded picture that the network sees, with the faults of
 * cameras and of cut-out masks. All random numbers come from the generators that are passed in. */
#ifndef MERLIN_LAB_TRAIN_SAMPLES_TRAIN_CAMERA_H
#define MERLIN_LAB_TRAIN_SAMPLES_TRAIN_CAMERA_H

#include "base/rng.h"
#include "image/write/jpeg.h"
#include "lab/train/config/train_config.h"
#include "lab/train/samples/dataset.h"

/* Faults of a photograph; train_camera_perfect for none. */
typedef struct train_camera {
    float gain[3];    /* error of exposure and colour balance */
    float white;      /* radiance at which the sensor saturates, at least 1 */
    float shot, read; /* noise of standard deviation sqrt(shot I + read²), I in [0, 1] of white */
    bool eight_bit;   /* rounded to 8 bits of sRGB */
    /* set by train_camera_add_response: */
    float gamma, contrast; /* of the camera's tone curve, applied to sRGB codes; 1 and 0: sRGB alone */
    float vignette;        /* share of the light lost in the frame's corners */
    /* set by train_camera_degrade: */
    bool background;        /* there is a background, which shows at the object's outline */
    float behind[2][3];     /* its radiance: a linear gradient between two values ... */
    float across[2];        /* ... whose direction and extent this is, in frames to the right and downwards */
    int outline;            /* the mask is dilated (1) or eroded (-1) by a pixel */
    bool jpeg;              /* compressed ... */
    img_jpeg jpeg_settings; /* ... with these settings */
} train_camera;

train_camera train_camera_perfect(void);
/* Chooses exposure and colour as configured; noise up to 1.5 % of full scale and 8 bits in half of all photographs
 * each. The sensor's white is between radiance 1, as in the published data, at which two pixels in five of bright
 * objects are saturated, and 2.5, where a white object keeps its shading as in a well exposed photograph. */
train_camera train_camera_draw(const train_config *c, rng *r);
/* Adds background, errors of the outline and JPEG to the configured shares of photographs, and makes the camera perfect
 * for the share that is to be as in the paper. */
void train_camera_degrade(const train_config *c, rng *r, train_camera *lens);

/* Gives half of all photographs a manufacturer's tone curve, which is usually unknown, and a third a lens with
 * vignetting. */
void train_camera_add_response(rng *r, train_camera *lens);

/* Computes the network's input "image", encoded, from the light of the view's pictures (direct, with `global` indirect,
 * and env; or photo, if it is there). It is zero outside the mask as cut out; inside, loss_mask is 1. mask is still
 * coverage. MERLIN_NO_MEMORY. */
status train_photograph(const train_view *v, bool global, const train_camera *lens, rng *noise);

#endif
