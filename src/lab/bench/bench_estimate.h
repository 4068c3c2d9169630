/* SPDX-License-Identifier: MIT */
/* Measures `merlin estimate` of one picture as a separate process, and the memory that a process holds. For bench.c. */
#ifndef MERLIN_LAB_BENCH_BENCH_ESTIMATE_H
#define MERLIN_LAB_BENCH_BENCH_ESTIMATE_H

#include <stddef.h>

#include "base/status.h"

enum { BENCH_PARTS = 11 };

/* One part of the time, in the order of execution. */
typedef struct bench_part {
    const char *name; /* as in `merlin estimate --json`; the last one, "end", is the rest of the process's time */
    double seconds;
} bench_part;

typedef struct bench_estimation {
    double seconds;               /* median, from the process's start to its end */
    bench_part part[BENCH_PARTS]; /* of that run */
    size_t bytes;                 /* peak memory of any of the processes */
} bench_estimation;

/* Runs the measurement. The picture (a shiny ball on black, 256×256) and its results are in a temporary folder that is
 * removed. It must be called before this process grows: the system counts the parent's memory at the start of a child
 * as the child's. */
status bench_estimate(const char *program, const char *weights, int runs, bench_estimation *out);

/* Reset and read this process's peak memory: 0 if the system does not tell. */
void bench_reset_resident(void);
size_t bench_peak_resident(void);

#endif
