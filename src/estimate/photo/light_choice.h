/* SPDX-License-Identifier: MIT */
/* The choice between two networks for a photograph: one of any light, and one that knows a flash at the lens alone, and
 * better.
 *
 *     network *n;
 *     status s = light_choice(any, flash, &(light_question){&photo, &mask, &how, shot.flash}, &n);
 */
#ifndef MERLIN_ESTIMATE_PHOTO_LIGHT_CHOICE_H
#define MERLIN_ESTIMATE_PHOTO_LIGHT_CHOICE_H

#include "base/api_needs.h"
#include "estimate/photo/network.h"
#include "merlin/merlin.h"

typedef struct light_question {
    const img *photo, *mask; /* as of network_estimate */
    const sight *how;
    merlin_flash fired;
} light_question;

/* flash: NULL for `any` without a question. The photographer's word (how->flash) counts, then the camera's that no
 * flash fired, then what `any` sees in one orientation. */
status light_choice(network *any, network *flash, const light_question *q, network **out);

#endif
