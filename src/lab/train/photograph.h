/* SPDX-License-Identifier: MIT */
/* A camera's part in a presentation: from radiance to the encoded picture that the network sees, with what cameras and
 * whoever cut the object out do to it. Everything random comes from the generators that are handed in. */
#ifndef MERLIN_LAB_TRAIN_PHOTOGRAPH_H
#define MERLIN_LAB_TRAIN_PHOTOGRAPH_H

#include "base/rng.h"
#include "image/write/jpeg.h"
#include "lab/train/dataset.h"
#include "lab/train/train_config.h"

/* What spoils a photograph; train_camera_perfect for none. */
typedef struct train_camera {
    float gain[3];    /* error of exposure and colour balance */
    float white;      /* radiance at which the sensor saturates, at least 1 */
    float shot, read; /* noise of standard deviation sqrt(shot I + read²), I in [0, 1] of white */
    bool eight_bit;   /* rounded to 8 bits of sRGB */
    /* train_camera_add_response: */
    float gamma, contrast; /* of the camera's own curve, applied to sRGB codes; 1 and 0: sRGB alone */
    float vignette;        /* share of the light that is lost in the frame's corners */
    /* train_camera_degrade: */
    bool background;        /* something lies behind the object, which shows at its outline */
    float behind[2][3];     /* its radiance, even between two ends of the frame ... */
    float across[2];        /* ... which lie so far apart, in frames to the right and downwards */
    int outline;            /* the mask is a pixel too large (1) or too small (-1) */
    bool jpeg;              /* compressed ... */
    img_jpeg jpeg_settings; /* ... like this */
} train_camera;

train_camera train_camera_perfect(void);
/* Exposure and colour as configured; noise up to 1.5 % of full scale and 8 bits in half of all photographs each. The
 * sensor's white lies between radiance 1, the published data's, at which two pixels in five of bright objects burn out,
 * and 2.5, where a white object keeps its shading as in a photograph exposed for it. */
train_camera train_camera_draw(const train_config *c, rng *r);
/* Adds background, errors of the outline and JPEG to the shares of photographs that the configuration says, and makes
 * the camera perfect for the share that is to be as in the paper. */
void train_camera_degrade(const train_config *c, rng *r, train_camera *lens);

/* Half of all photographs have a curve of the camera's maker, which nobody undoes; a third, a lens that loses light. */
void train_camera_add_response(rng *r, train_camera *lens);

/* The network's input "image", encoded, of the light in the view's pictures (direct, with `global` indirect, and env;
 * or photo, where that is there), zero where whoever cut the object out saw none; there, loss_mask is 1. mask is still
 * coverage. MERLIN_NO_MEMORY. */
status train_photograph(const train_view *v, bool global, const train_camera *lens, rng *noise);

#endif
