/* SPDX-License-Identifier: MIT */
/* The choice between two networks for a photograph: one for any light, and one for a flash at the lens alone, which is
 * better there.
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
    const img *photo, *mask; /* as for network_estimate */
    const sight *how;
    merlin_flash fired;
} light_question;

/* Chooses by the photographer's statement (how->flash), else by the camera's that no flash fired, else by what `any`
 * estimates in one orientation. flash: NULL always chooses `any`. */
status light_choice(network *any, network *flash, const light_question *q, network **out);

#endif
