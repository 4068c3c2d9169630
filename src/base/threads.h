/* SPDX-License-Identifier: MIT */
/* The number of threads in parallel loops, and how these threads wait.
 *
 *     threads_use(4);       // every thread's loops, from its next threads_begin on
 *     threads_begin();      // before the first loop of a piece of work
 *
 * OpenMP ends the program if it is refused a thread, so that the number is checked before OpenMP asks for them. */
#ifndef MERLIN_BASE_THREADS_H
#define MERLIN_BASE_THREADS_H

#include <stdbool.h>

enum { THREADS_MOST = 1024 };

/* Prepares the calling thread's loops: no more threads than the system grants, and such as go to sleep soon when idle.
 * Repeated calls are cheap. */
void threads_begin(void);

/* Sets how many threads the loops of every thread have from its next threads_begin on, instead of OMP_NUM_THREADS or
 * one a processor: 1 to THREADS_MOST, or as many of them as the system grants. */
void threads_use(int count);

/* Sets the number for the calling thread alone, immediately. */
void threads_use_here(int count);

/* Tells whether so many more threads could be started now: called before libraries that end the program otherwise. */
bool threads_are_left(int count);

#endif
