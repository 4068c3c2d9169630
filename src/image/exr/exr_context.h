/* SPDX-License-Identifier: MIT */
/* An OpenEXR Core context that never prints, shared by reading and writing.
 *
 * The library's error messages are kept per thread, not in the context's user data: while writing it calls the error
 * handler with its lock held, and asking it for the user data there deadlocks (3.1.5). */
#ifndef MERLIN_IMAGE_EXR_EXR_CONTEXT_H
#define MERLIN_IMAGE_EXR_EXR_CONTEXT_H

#include <OpenEXR/openexr.h>
#include <stdbool.h>

#include "base/status.h"

/* Returns an initializer with a silent error handler, and clears this thread's stored message. */
exr_context_initializer_t exr_quiet(void);
void exr_forget_complaint(void);

/* Tells whether the first message since it was cleared contains these words. */
bool exr_complained_of(const char *words);

/* Fails with "cannot VERB PATH: the library's first message since it was cleared" and status s, or with
 * lack of memory. */
status exr_fail(status s, const char *verb, const char *path, exr_result_t code);

#endif
