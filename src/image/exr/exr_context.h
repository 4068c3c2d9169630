/* SPDX-License-Identifier: MIT */
/* What reading and writing EXR share: an OpenEXR Core context that never prints.
 *
 * The library's complaints are kept by thread, not in the context's user data: while writing it calls the error handler
 * with its lock held, and asking it for the user data there waits for ever (3.1.5). */
#ifndef MERLIN_IMAGE_EXR_EXR_CONTEXT_H
#define MERLIN_IMAGE_EXR_EXR_CONTEXT_H

#include <OpenEXR/openexr.h>
#include <stdbool.h>

#include "base/status.h"

/* An initializer with a silent error handler; forgets this thread's complaints so far. */
exr_context_initializer_t exr_quiet(void);
void exr_forget_complaint(void);

/* Says whether the first complaint since the last forgetting has the words in it. */
bool exr_complained_of(const char *words);

/* "cannot VERB PATH: the library's first words since the last forgetting" with status s. */
status exr_fail(status s, const char *verb, const char *path, exr_result_t code);

#endif
