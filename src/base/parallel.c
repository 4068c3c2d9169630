/* SPDX-License-Identifier: MIT */
#include "base/parallel.h"

#include <omp.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>

#include "base/threads.h"

void parallel_for(size_t count, void (*body)(void *context, size_t i), void *context)
{
    threads_begin();
#pragma omp parallel for schedule(dynamic, 1)
    for (size_t i = 0; i < count; i++)
        body(context, i);
}

/* A loop whose bodies can fail. Messages are kept per thread, and threads end, so that the first failure's is copied
 * here. */
typedef struct trial {
    status (*body)(void *context, size_t i);
    void *context;
    atomic_size_t first; /* lowest index that failed; SIZE_MAX: none */
    status result;
    char message[1024];
} trial;

static void note_failure(trial *t, size_t i, status result)
{
#pragma omp critical(parallel_try)
    if (i < t->first) {
        t->first = i;
        t->result = result;
        snprintf(t->message, sizeof t->message, "%s", status_message());
    }
}

/* Runs one index unless a lower one has failed: those below must still run, as they may fail too and would then be the
 * first. */
static void try_one(void *context, size_t i)
{
    trial *t = context;
    if (i > t->first) return;
    status result = t->body(t->context, i);
    if (result != OK) note_failure(t, i, result);
}

status parallel_try(size_t count, status (*body)(void *context, size_t i), void *context)
{
    trial t = {.body = body, .context = context, .first = SIZE_MAX, .result = OK};
    parallel_for(count, try_one, &t);
    return t.result == OK ? OK : fail(t.result, "%s", t.message);
}

void parallel_blocks(size_t count, void (*body)(void *context, size_t begin, size_t end), void *context)
{
    threads_begin();
#pragma omp parallel
    {
        size_t threads = (size_t)omp_get_num_threads(), t = (size_t)omp_get_thread_num();
        size_t begin = count * t / threads, end = count * (t + 1) / threads;
        if (begin < end) body(context, begin, end);
    }
}

int parallel_threads(void)
{
    return omp_get_max_threads();
}
