/* SPDX-License-Identifier: MIT */
#include "lab/bench/bench_time.h"

#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "base/progress.h"
#include "lab/eval/metrics/metrics.h"

enum { MAX_RUNS = 64, COPY_BYTES = 256 << 20 };

bench_budget bench_budget_of(bool quick)
{
    return quick ? (bench_budget){3, 0.5} : (bench_budget){9, 4};
}

status bench_time(bench_work work, void *context, bench_budget p, double *seconds)
{
    double times[MAX_RUNS];
    int runs = 0;
    status s = work(context);
    for (double begun = clock_seconds(), now = begun; s == OK && runs < MAX_RUNS; runs++) {
        if (runs >= p.least && now - begun > p.seconds) break;
        double started = now;
        s = work(context);
        now = clock_seconds();
        times[runs] = now - started;
    }
    if (s != OK) return s;
    *seconds = eval_median(times, (size_t)runs);
    return OK;
}

typedef struct copy_work {
    char *from, *to;
} copy_work;

static void copy_block(void *context, size_t begin, size_t end)
{
    const copy_work *c = context;
    memcpy(c->to + begin, c->from + begin, end - begin);
}

static status copy_all(void *context)
{
    parallel_blocks(COPY_BYTES, copy_block, context);
    return OK;
}

status bench_copy_rate(bench_budget p, double *rate)
{
    copy_work c = {malloc(COPY_BYTES), malloc(COPY_BYTES)};
    double seconds = 0;
    status s;
    if (c.from && c.to) {
        memset(c.from, 1, COPY_BYTES); /* untouched pages are all the same page of zeros */
        s = bench_time(copy_all, &c, p, &seconds);
    } else {
        s = fail(MERLIN_NO_MEMORY, "no memory to measure the rate of copying");
    }
    free(c.from);
    free(c.to);
    if (s == OK) *rate = 2.0 * COPY_BYTES / seconds;
    return s;
}
