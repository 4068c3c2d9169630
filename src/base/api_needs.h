/* SPDX-License-Identifier: MIT */
/* The common beginning of all public functions. */
#ifndef MERLIN_BASE_API_NEEDS_H
#define MERLIN_BASE_API_NEEDS_H

#include <stdbool.h>

#include "base/status.h"
#include "base/threads.h"

/* Prepares the threads of a public function's loops; returns MERLIN_WRONG_USE if an argument that it needs was NULL. */
static inline status api_needs(const char *function, bool all_there)
{
    threads_begin();
    return all_there ? OK : fail(MERLIN_WRONG_USE, "%s was called with a null pointer", function);
}

#endif
