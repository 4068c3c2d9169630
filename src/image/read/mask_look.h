/* SPDX-License-Identifier: MIT */
/* Whether a picture looks like a mask, where its name leaves that open. */
#ifndef MERLIN_IMAGE_READ_MASK_LOOK_H
#define MERLIN_IMAGE_READ_MASK_LOOK_H

#include <stdbool.h>

/* Tells whether a picture has two values and little between them; false for what cannot be read. */
bool mask_is_two_valued(const char *path);

#endif
