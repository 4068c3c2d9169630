/* SPDX-License-Identifier: MIT */
/* Decides by content whether a picture is a mask, where its name leaves that open. */
#ifndef MERLIN_IMAGE_READ_MASK_LOOK_H
#define MERLIN_IMAGE_READ_MASK_LOOK_H

#include <stdbool.h>

/* Tells whether a picture has two values and little between them; false if it cannot be read. */
bool mask_is_two_valued(const char *path);

#endif
