/* SPDX-License-Identifier: MIT */
/* Marks on calls into libraries that end the program, or crash, where the system refuses them memory or a thread:
 * oneDNN's machine code, GLib behind libvips.
 *
 *     status s = fragile_begin("the network", 32 << 20);      says at once where that much is not to be had
 *     if (s != OK) return s;
 *     dnnl_primitive_create(...);
 *     fragile_end();
 *
 * A program that is dying of a signal can thus tell that from a fault of its own. */
#ifndef MERLIN_BASE_FRAGILE_H
#define MERLIN_BASE_FRAGILE_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

/* MERLIN_NO_MEMORY where so many bytes are not to be had; then there is nothing to end. Any thread, in pairs. */
status fragile_begin(const char *what, size_t bytes);
void fragile_end(void);

/* Tells if the calling thread is in such a call; for a signal's handler. */
bool fragile_is_here(void);
/* Tells if any thread is: libraries have threads of their own. */
bool fragile_is_anywhere(void);

#endif
