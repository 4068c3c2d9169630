/* SPDX-License-Identifier: MIT */
/* One picture through `merlin estimate` as a process of its own, and what a process holds. For bench.c. */
#ifndef MERLIN_LAB_BENCH_BENCH_ESTIMATE_H
#define MERLIN_LAB_BENCH_BENCH_ESTIMATE_H

#include <stddef.h>

#include "base/status.h"

enum { BENCH_PARTS = 11 };

/* Where the time goes, in this order. */
typedef struct bench_part {
    const char *name; /* as in `merlin estimate --json`; the last one, "end", is what the program does not see itself */
    double seconds;
} bench_part;

typedef struct bench_estimation {
    double seconds;               /* median, from the process's start to its end */
    bench_part part[BENCH_PARTS]; /* of that run */
    size_t bytes;                 /* the most that any of the processes held */
} bench_estimation;

/* The picture (a shiny ball on black, 256×256) and what is made of it live in a temporary folder that is removed. Call
 * it before this process grows: the system counts what the parent held at the start of a child as the child's. */
status bench_estimate(const char *program, const char *weights, int runs, bench_estimation *out);

/* Starts counting anew what this process holds at most, and reads it: 0 if the system does not tell. */
void bench_reset_resident(void);
size_t bench_peak_resident(void);

#endif
