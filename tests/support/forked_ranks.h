/* SPDX-License-Identifier: MIT */
/* Ranks that are forked processes of this one and speak through shared memory: what MPI does, without it. */
#ifndef MERLIN_TESTS_FORKED_RANKS_H
#define MERLIN_TESTS_FORKED_RANKS_H

#include "base/ranks/ranks.h"

/* Memory that all ranks see, zeroed. Ends the test where there is none. */
void *forked_memory(size_t bytes);
/* body(rank, context) in `count` processes; returns how many of them ended by exit status 0, which is what they do
 * after body. What is to be kept must be in memory of forked_memory. */
int forked_run(int count, void (*body)(ranks *r, void *context), void *context);

#endif
