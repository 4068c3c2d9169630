/* SPDX-License-Identifier: MIT */
/* Parallel loops over OpenMP. Results never depend on the number of threads: bodies write only what index i owns. */
#ifndef MERLIN_BASE_PARALLEL_H
#define MERLIN_BASE_PARALLEL_H

#include <stddef.h>

#include "base/status.h"

/* Calls body(context, i) for every i in [0, count), handing out iterations one by one. */
void parallel_for(size_t count, void (*body)(void *context, size_t i), void *context);

/* Runs such a loop whose bodies can fail: returns the status and sets the message of the first that failed, by i.
 * Bodies after it may not have run. */
status parallel_try(size_t count, status (*body)(void *context, size_t i), void *context);

/* Calls body(context, begin, end) on contiguous blocks that tile [0, count), one block a thread. */
void parallel_blocks(size_t count, void (*body)(void *context, size_t begin, size_t end), void *context);

/* Returns the number of threads in the calling thread's loops (base/threads.h). */
int parallel_threads(void);

#endif
