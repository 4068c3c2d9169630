/* SPDX-License-Identifier: MIT */
/* Ranks that are forked processes and communicate through shared memory: a replacement for MPI. */
#ifndef MERLIN_TESTS_FORKED_RANKS_H
#define MERLIN_TESTS_FORKED_RANKS_H

#include "base/ranks/ranks.h"

/* Returns zeroed memory shared by all ranks. Ends the test if there is none. */
void *forked_memory(size_t bytes);
/* Runs body(rank, context) in `count` processes; returns how many ended with exit status 0, as they do after body.
 * Results must be written to memory of forked_memory. */
int forked_run(int count, void (*body)(ranks *r, void *context), void *context);

#endif
