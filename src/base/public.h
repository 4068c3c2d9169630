/* SPDX-License-Identifier: MIT */
/* What public functions begin with. */
#ifndef MERLIN_BASE_PUBLIC_H
#define MERLIN_BASE_PUBLIC_H

#include <stdbool.h>

#include "base/status.h"
#include "base/threads.h"

/* Begins a public function: MERLIN_WRONG_USE where it got NULL for something that it needs. */
static inline status api_needs(const char *function, bool all_there)
{
    threads_begin();
    return all_there ? OK : fail(MERLIN_WRONG_USE, "%s was called with a null pointer", function);
}

#endif
