/* SPDX-License-Identifier: MIT */
/* merlin_estimate in two steps, and what the first finds: which part of a photograph is the object. */
#ifndef MERLIN_ESTIMATE_PHOTO_PHOTO_OBJECT_H
#define MERLIN_ESTIMATE_PHOTO_PHOTO_OBJECT_H

#include "base/watch.h"
#include "estimate/object/mask.h"
#include "estimate/photo/light_cues.h"
#include "estimate/surface/crop.h"
#include "image/image.h"
#include "merlin/merlin.h"

/* Which part of a photograph is the object. */
typedef struct photo_object {
    img mask;
    mask_choice choice;
    crop_square crop;
    merlin_shot shot;   /* unknown, unless it is told */
    light_cues cues;    /* what estimate_object found of the light */
    const watch *watch; /* told of what estimate_object does; may be NULL */
    bool last;          /* no photograph follows: the network that is not chosen is closed */
    double seconds;     /* that finding it took */
} photo_object;

/* merlin_estimate in two steps, so that the object can be searched for while the model is still being read. given may
 * be NULL or empty, hint NULL; estimate_object takes the mask and the photograph over, whatever it returns, and frees
 * them as soon as it can. */
status photo_object_choose(const merlin_image *photo, const merlin_image *given, const merlin_hint *hint,
                           photo_object *out);
void photo_object_free(photo_object *object);
status estimate_object(merlin_model *model, merlin_image *photo, photo_object *object, const merlin_params *params,
                       merlin_maps *maps);

#endif
