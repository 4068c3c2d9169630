/* SPDX-License-Identifier: MIT */
/* Chooses the mask of a photograph's object: the given one, or one that is found. */
#ifndef MERLIN_ESTIMATE_OBJECT_MASK_H
#define MERLIN_ESTIMATE_OBJECT_MASK_H

#include <stdbool.h>

#include "image/image.h"
#include "merlin/merlin.h"

/* Confidence of a found mask from which on it is used without a warning. */
#define MASK_LITTLE_CONFIDENCE 0.5f

typedef struct mask_choice {
    bool found;       /* whether find_object found it, as none was given */
    float confidence; /* probability that it is right; 1 if given */
} mask_choice;

/* Makes the mask. given: 1 channel of the photograph's size (else MERLIN_BAD_INPUT); if it is NULL or has no data, the
 * object is searched for, by the hint, which may be NULL. MERLIN_WRONG_USE for a hint together with a mask, or one
 * outside the photograph. Values below 0.05 count as 0 and above 0.95 as 1, so that a mask that was saved as JPEG has
 * clean sides. */
status mask_choose(const img *photo, const img *given, const merlin_hint *hint, img *mask, mask_choice *choice);

/* Sets values below 0.05 to zero and those above 0.95 to one, which also removes the ringing of an enlargement. */
void mask_clean(img *mask);

#endif
