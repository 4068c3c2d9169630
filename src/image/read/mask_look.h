/* SPDX-License-Identifier: MIT */
/* Decides by content whether a picture is a mask, where its name leaves that open. */
#ifndef MERLIN_IMAGE_READ_MASK_LOOK_H
#define MERLIN_IMAGE_READ_MASK_LOOK_H

#include <stdbool.h>

#include "base/status.h"

/* Finds whether a picture has two values and little between them; false if it cannot be read. Fails with
 * MERLIN_NO_MEMORY only. */
status mask_look(const char *path, bool *is_two_valued);

#endif
