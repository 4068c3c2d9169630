/* One picture through `merlin estimate` as a process of its own, and what a process holds. For bench.c. */
#ifndef MERLIN_EVAL_BENCH_ESTIMATE_H
#define MERLIN_EVAL_BENCH_ESTIMATE_H

#include <stddef.h>

#include "base/status.h"

/* Median seconds from the process's start to its end over `runs` runs, and the most memory it held. The picture (a
 * shiny ball on black, 256×256) and what is made of it live in a temporary folder that is removed. Call it before this
 * process grows: the system counts what the parent held at the start of a child as the child's. */
status bench_estimate(const char *program, const char *weights, int runs, double *seconds, size_t *bytes);

/* Starts counting anew what this process holds at most, and reads it: 0 if the system does not tell. */
void bench_reset_resident(void);
size_t bench_peak_resident(void);

#endif
