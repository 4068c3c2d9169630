/* SPDX-License-Identifier: MIT */
/* Why the maps of a photograph may be wrong: merlin_maps' doubts found, and put into words. */
#ifndef MERLIN_ESTIMATE_PHOTO_PHOTO_DOUBTS_H
#define MERLIN_ESTIMATE_PHOTO_PHOTO_DOUBTS_H

#include "base/warnings.h"
#include "estimate/photo/light_cues.h"
#include "merlin/merlin.h"

/* From maps that are complete; how is what is known of the shot. */
void doubts_find(const light_cues *cues, const merlin_shot *shot, merlin_maps *maps);
/* Adds them to a list, the gravest first. */
void doubts_list(const merlin_maps *maps, warnings *list);

#endif
