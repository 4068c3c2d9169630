/* SPDX-License-Identifier: MIT */
/* Reasons why the maps of a photograph may be wrong: finds merlin_maps' doubts, and describes them. */
#ifndef MERLIN_ESTIMATE_PHOTO_PHOTO_DOUBTS_H
#define MERLIN_ESTIMATE_PHOTO_PHOTO_DOUBTS_H

#include "estimate/photo/light_cues.h"
#include "merlin/merlin.h"

/* Finds the doubts of complete maps, given what is known about the exposure. */
void doubts_find(const light_cues *cues, const merlin_shot *shot, merlin_maps *maps);

#endif
