/* SPDX-License-Identifier: MIT */
/* Which part of a photograph is the object. */
#ifndef MERLIN_ESTIMATE_OBJECT_MASK_H
#define MERLIN_ESTIMATE_OBJECT_MASK_H

#include <stdbool.h>

#include "image/image.h"
#include "merlin/merlin.h"

/* A found mask's confidence from which it is taken without a word. */
#define MASK_LITTLE_CONFIDENCE 0.5f

typedef struct mask_choice {
    bool found;       /* by find_object, because none was given */
    float confidence; /* 1 if given */
} mask_choice;

/* given: 1 channel of the photograph's size (else MERLIN_BAD_INPUT), or NULL or without data: the object is searched
 * for, by the hint, which may be NULL. MERLIN_WRONG_USE for a hint beside a mask, or one that lies outside the
 * photograph. Values below 0.05 count as 0 and above 0.95 as 1, so that a mask that went through JPEG has clean sides.
 */
status mask_choose(const img *photo, const img *given, const merlin_hint *hint, img *mask, mask_choice *choice);

/* Makes values below 0.05 zero and those above 0.95 one: what an enlargement rings by, too. */
void mask_clean(img *mask);

#endif
