/* SPDX-License-Identifier: MIT */
/* Measures the cost of each additional light. For bench.c. */
#ifndef MERLIN_LAB_BENCH_BENCH_RELIGHT_H
#define MERLIN_LAB_BENCH_BENCH_RELIGHT_H

#include "lab/bench/bench_time.h"

enum { BENCH_WAYS = 3 };

typedef struct bench_relighting {
    double ready_seconds[BENCH_WAYS]; /* to make a merlin_relighter of 256×256, by merlin_relighting */
    double light_seconds[BENCH_WAYS]; /* for each light on it */
} bench_relighting;

status bench_relight(const char *weights, bench_budget patience, bench_relighting *out);

#endif
