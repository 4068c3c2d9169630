/* SPDX-License-Identifier: MIT */
/* A sample as somebody photographs it, and what merlin_estimate makes of the photograph: the one way by which the
 * evaluations ask the product.
 *
 *     eval_photo photo;
 *     merlin_maps maps = {0};
 *     surface found = {0};
 *     status s = eval_photo_take(&sample, &radiance, &sample.mask, EXPOSURE_WHITE, &photo);
 *     if (s == OK) s = eval_photo_estimate(model, &photo, &maps);
 *     if (s == OK) s = eval_photo_surface(&photo, &maps, &found);      to be held against eval_truth
 *
 * merlin_estimate may crop the photograph, and its maps are seen by a camera that looks at the crop's middle then. Here
 * they become what the sample's own camera sees. */
#ifndef MERLIN_LAB_EVAL_SAMPLES_PHOTOGRAPH_H
#define MERLIN_LAB_EVAL_SAMPLES_PHOTOGRAPH_H

#include "estimate/surface/surface.h"
#include "lab/render/sample.h"
#include "merlin/merlin.h"

typedef struct eval_photo {
    img picture;          /* 3, linear: 1 is where it saturates */
    img mask;             /* 1, coverage */
    float white;          /* the radiance that 1 stands for */
    camera_lens lens;     /* the sample's */
    int x, y;             /* where the picture is in the photograph, */
    int width, height;    /* which is larger where the sample was cut out away from the lens's axis, */
    float fov;            /* and so many degrees wide */
    merlin_params params; /* the defaults, but that this is known */
} eval_photo;

/* Exposes the picture. radiance: what the sample's camera sees, 3 channels. mask: 1 channel, outside of which the
 * photograph is black. */
status eval_photo_take(const sample *s, const img *radiance, const img *mask, float white, eval_photo *out);
void eval_photo_free(eval_photo *photo);

/* Calls merlin_estimate. */
status eval_photo_estimate(merlin_model *model, const eval_photo *photo, merlin_maps *maps);

/* Makes the maps what the sample's camera sees: merlin_estimate's own, unless it cropped. */
status eval_photo_surface(const eval_photo *photo, const merlin_maps *maps, surface *out);
/* Turns a place or a direction from the sample's space to the maps', and back. */
vec3 eval_photo_to_maps(const eval_photo *photo, const merlin_maps *maps, vec3 at);
vec3 eval_photo_from_maps(const eval_photo *photo, const merlin_maps *maps, vec3 at);
/* Cuts the sample's square out of a picture of the photograph's size. */
status eval_photo_cut(const eval_photo *photo, const merlin_image *picture, img *out);
/* Makes a picture of the photograph's size and exposure radiance clipped to [0, 1], of the sample's size. */
status eval_photo_radiance(const eval_photo *photo, const merlin_image *picture, img *out);

#endif
