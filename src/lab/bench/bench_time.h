/* SPDX-License-Identifier: MIT */
/* Time measurement, and the machine's rate of copying memory for comparison.
 *
 *     double seconds;
 *     status s = bench_time(run_it, &work, bench_budget_of(quick), &seconds);      the median of several runs
 */
#ifndef MERLIN_LAB_BENCH_BENCH_TIME_H
#define MERLIN_LAB_BENCH_BENCH_TIME_H

#include <stdbool.h>

#include "base/status.h"

/* Duration of a measurement: at least `least` runs, and more until `seconds` have passed. */
typedef struct bench_budget {
    int least;
    double seconds;
} bench_budget;

bench_budget bench_budget_of(bool quick);

typedef status (*bench_work)(void *context);

/* Measures the median seconds of a call, after one that is not counted. */
status bench_time(bench_work work, void *context, bench_budget p, double *seconds);

/* Measures the bytes read and written a second by memcpy on all threads. */
status bench_copy_rate(bench_budget p, double *rate);

#endif
