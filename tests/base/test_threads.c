/* SPDX-License-Identifier: MIT */
/* The number of threads in loops, and how soon waiting threads sleep. */
#include "base/threads.h"

#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#include "base/parallel.h"

#include <cmocka.h>

static double processor_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void nap(long milliseconds)
{
    nanosleep(&(struct timespec){milliseconds / 1000, milliseconds % 1000 * 1000000}, NULL);
}

/* Keeps one thread without work, waiting for the other, which sleeps. */
static void first_naps(void *context, size_t begin, size_t end)
{
    (void)context;
    (void)end;
    if (begin == 0) nap(20);
}

static void count_one(void *context, size_t i)
{
    atomic_fetch_add((atomic_int *)context + i, 1);
}

static void all_is_done_once(void)
{
    enum { COUNT = 200 };
    static atomic_int done[COUNT];
    memset(done, 0, sizeof done);
    parallel_for(COUNT, count_one, done);
    for (int i = 0; i < COUNT; i++)
        assert_int_equal(done[i], 1);
}

static size_t address_space(void)
{
    size_t pages = 0;
    FILE *f = fopen("/proc/self/statm", "r");
    assert_non_null(f);
    assert_int_equal(fscanf(f, "%zu", &pages), 1);
    fclose(f);
    return pages * (size_t)sysconf(_SC_PAGESIZE);
}

/* A thread's stack takes 8 MB, or what ulimit -s says: a few threads fit the limit, 500 do not. */
static void no_more_threads_are_used_than_can_be_had(void **state)
{
    (void)state;
    struct rlimit before, few;
    getrlimit(RLIMIT_STACK, &few);
    if (few.rlim_cur == RLIM_INFINITY || few.rlim_cur < 1 << 20) skip();
    getrlimit(RLIMIT_AS, &before);
    setrlimit(RLIMIT_AS, &(struct rlimit){address_space() + 20 * few.rlim_cur, before.rlim_max});
    threads_use_here(500);
    int threads = parallel_threads();
    all_is_done_once();
    setrlimit(RLIMIT_AS, &before);
    assert_in_range(threads, 2, 20);
}

static void the_most_threads_are_1024(void **state)
{
    (void)state;
    threads_use_here(100000);
    assert_in_range(parallel_threads(), 1, THREADS_MOST);
}

/* By default libgomp spins for milliseconds at each wait. */
static void who_waits_sleeps_within_half_a_millisecond(void **state)
{
    (void)state;
    enum { WAITS = 20 };
    threads_use_here(2);
    parallel_blocks(2, first_naps, NULL);
    nap(100); /* until all threads that were started sleep */
    double began = processor_seconds();
    for (int i = 0; i < WAITS; i++)
        parallel_blocks(2, first_naps, NULL);
    double each = (processor_seconds() - began) / WAITS;
    if (each > 0.5e-3) fail_msg("a wait of 20 ms took %.2f ms of a processor", 1e3 * each);
}

static void *threads_of_another(void *out)
{
    threads_begin();
    *(int *)out = parallel_threads();
    return NULL;
}

static void every_thread_has_as_many_as_was_said(void **state)
{
    (void)state;
    int others = 0;
    pthread_t other;
    threads_use(3);
    assert_int_equal(pthread_create(&other, NULL, threads_of_another, &others), 0);
    pthread_join(other, NULL);
    threads_begin();
    assert_int_equal(parallel_threads(), 3);
    assert_int_equal(others, 3);
    threads_use_here(2); /* the last call counts */
    threads_begin();
    assert_int_equal(parallel_threads(), 2);
}

int main(int argc, char **argv)
{
    (void)argc;
    /* libgomp read the environment at the start, so that it cannot be set here */
    if (getenv("OMP_WAIT_POLICY") || getenv("GOMP_SPINCOUNT")) {
        unsetenv("OMP_WAIT_POLICY");
        unsetenv("GOMP_SPINCOUNT");
        execv("/proc/self/exe", argv);
        return 1;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_more_threads_are_used_than_can_be_had), /* first, before there are stacks to be reused */
        cmocka_unit_test(who_waits_sleeps_within_half_a_millisecond),
        cmocka_unit_test(every_thread_has_as_many_as_was_said),
        cmocka_unit_test(the_most_threads_are_1024),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
