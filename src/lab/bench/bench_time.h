/* SPDX-License-Identifier: MIT */
/* How the bench measures time, and the rate of copying that it holds others against.
 *
 *     double seconds;
 *     status s = bench_time(run_it, &work, bench_budget_of(quick), &seconds);      the median of several runs
 */
#ifndef MERLIN_LAB_BENCH_BENCH_TIME_H
#define MERLIN_LAB_BENCH_BENCH_TIME_H

#include <stdbool.h>

#include "base/status.h"

/* How long to measure: at least `least` runs, then on until `seconds` have passed. */
typedef struct bench_budget {
    int least;
    double seconds;
} bench_budget;

bench_budget bench_budget_of(bool quick);

typedef status (*bench_work)(void *context);

/* Median seconds of one call, after one that is not counted. */
status bench_time(bench_work work, void *context, bench_budget p, double *seconds);

/* Bytes read and written a second by memcpy on all threads. */
status bench_copy_rate(bench_budget p, double *rate);

#endif
