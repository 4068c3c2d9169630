/* SPDX-License-Identifier: MIT */
/* Marks calls into libraries that end the program, or crash, when the system refuses them memory or a thread: oneDNN's
 * machine code, GLib behind libvips.
 *
 *     status s = fragile_begin("the network", 32 << 20);      fails if 32 MiB cannot be had
 *     if (s != OK) return s;
 *     dnnl_primitive_create(...);
 *     fragile_end();
 *
 * By these marks a program that receives a fatal signal can tell a lack of memory from a bug of its own. */
#ifndef MERLIN_BASE_FRAGILE_H
#define MERLIN_BASE_FRAGILE_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

/* Begins such a call; returns MERLIN_NO_MEMORY if so many bytes cannot be had, and then fragile_end must not follow.
 * May be called from any thread; calls come in pairs. */
status fragile_begin(const char *what, size_t bytes);
void fragile_end(void);

/* Tells whether the calling thread is inside such a call; safe in a signal handler. */
bool fragile_is_here(void);
/* Tells whether any thread is inside such a call: libraries also crash in threads of their own. */
bool fragile_is_anywhere(void);

#endif
