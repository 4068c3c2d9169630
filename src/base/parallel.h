/* SPDX-License-Identifier: MIT */
/* Parallel loops over OpenMP. Results never depend on the number of threads: bodies write only what index i owns. */
#ifndef MERLIN_BASE_PARALLEL_H
#define MERLIN_BASE_PARALLEL_H

#include <stddef.h>

#include "base/status.h"

/* body(context, i) for every i in [0, count), iterations handed out one by one. */
void parallel_for(size_t count, void (*body)(void *context, size_t i), void *context);

/* The same with bodies that can fail: the caller hears what the first of them, by i, returned and said. Those behind it
 * may not have been begun. */
status parallel_try(size_t count, status (*body)(void *context, size_t i), void *context);

/* body(context, begin, end) over contiguous blocks that tile [0, count), one block a thread. */
void parallel_blocks(size_t count, void (*body)(void *context, size_t begin, size_t end), void *context);

/* Returns how many threads the loops of the calling thread have (base/threads.h). */
int parallel_threads(void);

#endif
