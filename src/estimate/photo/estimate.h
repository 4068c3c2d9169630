/* SPDX-License-Identifier: MIT */
/* merlin_estimate_object (merlin/estimate.h) for callers that also need the cues for the light. */
#ifndef MERLIN_ESTIMATE_PHOTO_ESTIMATE_H
#define MERLIN_ESTIMATE_PHOTO_ESTIMATE_H

#include "estimate/photo/light_cues.h"
#include "estimate/surface/crop.h"
#include "merlin/estimate.h"
#include "model/model.h"

/* Estimates as merlin_estimate_object does, and returns the cues from which the warning about the light is derived. */
status estimate_with_cues(merlin_model *model, merlin_image *photo, merlin_object *object, const merlin_params *params,
                          light_cues *cues, merlin_maps *maps);

/* Choices that frames of a sequence have in common, instead of what each would get on its own. */
typedef struct estimate_held {
    crop_square crop;  /* holds the object; with side 0 it is chosen */
    const char *model; /* name of the network, of a pair; NULL: chosen */
    float gain;        /* that of the last frame; 0: none */
    float new_share;   /* share of this frame's own gain in the mean with that */
} estimate_held;

/* Estimates as merlin_estimate_object does, with what is held. */
status estimate_with_held(merlin_model *model, merlin_image *photo, merlin_object *object, const merlin_params *params,
                          const estimate_held *held, merlin_maps *maps);

/* Further photographs of an object, each under another light, from the place of the first one. */
typedef struct estimate_further {
    int count;
    status (*take)(void *context, int number, img *out); /* makes one of them, 3 channels of the first one's size */
    void *context;
    float (*lights)[MODEL_LIGHTS];   /* receives the lights of the first one and of these (model.h); may be NULL */
    float (*compared)[MODEL_LIGHTS]; /* the same by the model's network that compares the photographs, if it has one;
                                      * may be NULL */
} estimate_further;

/* Estimates as merlin_estimate does, from several photographs, of which all but the first are in memory one at a time.
 * photo and object are empty afterwards. MERLIN_WRONG_USE unless the model takes several. */
status estimate_several(merlin_model *model, merlin_image *photo, merlin_object *object, const merlin_params *params,
                        const estimate_further *further, merlin_maps *maps);

#endif
