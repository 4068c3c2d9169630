/* SPDX-License-Identifier: MIT */
/* The number of threads that parallel loops have, and the way in which these wait for each other.
 *
 *     threads_use(4);       // every thread's loops, from its next threads_begin on
 *     threads_begin();      // before the first loop of a piece of work
 *
 * OpenMP ends the program where a thread is refused: what can be had is found out before it is asked for. */
#ifndef MERLIN_BASE_THREADS_H
#define MERLIN_BASE_THREADS_H

#include <stdbool.h>

enum { THREADS_MOST = 1024 };

/* Makes the calling thread's loops ready: no more threads than can be had, and such as sleep soon where there is
 * nothing to do. Cheap when it is called again. */
void threads_begin(void);

/* Sets how many threads the loops of every thread have from its next threads_begin on, in place of OMP_NUM_THREADS or
 * one a processor: 1 to THREADS_MOST, or as many of them as can be had. */
void threads_use(int count);

/* The same for the calling thread alone, and at once. */
void threads_use_here(int count);

/* Tells if so many more threads could be started now: before libraries are called that end the program otherwise. */
bool threads_are_left(int count);

#endif
