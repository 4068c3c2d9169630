/* SPDX-License-Identifier: MIT */
/* --point and --box: help for the search for a photograph's object, for rows of command/options.h. */
#ifndef MERLIN_COMMAND_PHOTO_HINT_H
#define MERLIN_COMMAND_PHOTO_HINT_H

#include <stdbool.h>

#include "base/status.h"
#include "merlin/merlin.h"

/* The values of --point, which may be given again, "X,Y", and of --box, "X,Y,WIDTH,HEIGHT", in pixels from the upper
 * left corner; into is a merlin_hint. Whether they lie in the photograph is seen when that is read. */
status photo_take_point(const char *text, void *into);
status photo_take_box(const char *text, void *into);
/* Tells whether there is any. */
bool photo_hint_given(const merlin_hint *hint);
/* MERLIN_WRONG_USE where hints go with a mask, or with more than one photograph. */
status photo_check_hint(const merlin_hint *hint, const char *mask, bool several);

#endif
