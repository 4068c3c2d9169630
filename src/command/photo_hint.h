/* SPDX-License-Identifier: MIT */
/* --point and --box: hints for the search for a photograph's object, for rows of command/options.h. */
#ifndef MERLIN_COMMAND_PHOTO_HINT_H
#define MERLIN_COMMAND_PHOTO_HINT_H

#include <stdbool.h>

#include "base/status.h"
#include "merlin/merlin.h"

/* Take the values of --point, which may be repeated, "X,Y", and of --box, "X,Y,WIDTH,HEIGHT", in pixels from the upper
 * left corner; into is a merlin_hint. Whether they are inside the photograph is checked when that is read. */
status photo_take_point(const char *text, void *into);
status photo_take_box(const char *text, void *into);
/* Tells whether there is a hint. */
bool photo_hint_given(const merlin_hint *hint);
/* Fails with MERLIN_WRONG_USE if hints are combined with a mask, or with more than one photograph. */
status photo_check_hint(const merlin_hint *hint, const char *mask, bool several);

#endif
