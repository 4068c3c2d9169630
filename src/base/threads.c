/* SPDX-License-Identifier: MIT */
#include "base/threads.h"

#include <omp.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>
#include <unistd.h>

#include "base/status.h"

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER; /* of what follows */
static int tried, had; /* the most threads that were asked for, and how many of them there are */
static bool sleepers_started;

static atomic_int wanted; /* by threads_use; 0: OpenMP's own choice */
static atomic_uint changes;

/* The calling thread's number of threads for its loops, and the change that it has last heard of. */
static _Thread_local struct {
    int threads;
    unsigned change;
} settled;

static int smaller(int a, int b)
{
    return a < b ? a : b;
}

/* ---- how many threads there are to be had ---- */

static void *wait_for_all(void *gate)
{
    pthread_mutex_lock(gate);
    pthread_mutex_unlock(gate);
    return NULL;
}

/* Starts so many at once, as large as OpenMP's, and ends them again; returns how many there were. */
static int try_threads(int count)
{
    pthread_mutex_t gate = PTHREAD_MUTEX_INITIALIZER;
    pthread_t *thread = calloc((size_t)count, sizeof *thread);
    int started = 0;
    pthread_mutex_lock(&gate);
    while (thread && started < count && pthread_create(&thread[started], NULL, wait_for_all, &gate) == 0)
        started++;
    pthread_mutex_unlock(&gate);
    for (int i = 0; i < started; i++)
        pthread_join(thread[i], NULL);
    free(thread);
    return started;
}

bool threads_are_left(int count)
{
    return try_threads(count) == count;
}

/* ---- how they wait ---- */

/* libgomp's threads spin for milliseconds before they sleep, 300,000 turns, unless there are more of them than
 * processors: then 1000, some tens of microseconds, which costs an idle machine nothing. Beside other work the long
 * wait is for a thread that has no processor, and takes another's meanwhile (docs/notes/waiting_threads.md). The
 * environment can say so as well, but is read before main. So there are more of them: a team that never has anything to
 * do, and sleeps. */
static void *sleep_for_good(void *team)
{
#pragma omp parallel num_threads(*(int *)team)
    {
        __asm__ volatile("" ::: "memory"); /* an empty team would not be started */
    }
    free(team);
    while (pause() < 0) /* always */
        ;
    return NULL;
}

static void start_sleepers(int team)
{
    int *context = malloc(sizeof *context);
    sigset_t all, before;
    pthread_t sleeper;
    if (!context) return;
    *context = team;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before); /* the program's signals are for its own threads */
    if (pthread_create(&sleeper, NULL, sleep_for_good, context) == 0)
        pthread_detach(sleeper);
    else
        free(context);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
}

/* Whoever says in the environment how threads are to wait is heard. */
static bool waiting_is_chosen(void)
{
    return getenv("GOMP_SPINCOUNT") || getenv("OMP_WAIT_POLICY");
}

/* ---- both ---- */

/* Returns the size of the sleepers' team that makes OpenMP's threads more than processors beside a loop of so many. */
static int team_beside(int threads)
{
    int processors = omp_get_num_procs();
    return threads < processors ? processors - threads + 2 : 2;
}

/* Threads to be started for two such loops at once, one of them in the thread that reads a photograph ahead; another
 * converts weights ahead. */
static int needed_for(int threads)
{
    return 2 * (threads - 1) + 2;
}

/* The most of `count` for which `found` threads suffice, with the sleepers if they fit at all. */
static int share_out(int found, int count, bool *sleepers)
{
    *sleepers = !sleepers_started && !waiting_is_chosen();
    for (int t = count; *sleepers && t > 1; t--)
        if (needed_for(t) + team_beside(t) <= found) return t;
    *sleepers = false;
    for (int t = count; t > 1; t--)
        if (needed_for(t) <= found) return t;
    return 1;
}

static void find_out(int count)
{
    bool sleepers;
    had = share_out(try_threads(needed_for(count) + team_beside(count)), count, &sleepers);
    tried = count;
    if (!sleepers) return;
    start_sleepers(team_beside(had));
    sleepers_started = true;
}

/* So many threads, or as many of them as there are. */
static int grant(int count)
{
    if (count < 2) return 1;
    pthread_mutex_lock(&lock);
    if (count > tried) find_out(count);
    int threads = smaller(count, had);
    pthread_mutex_unlock(&lock);
    return threads;
}

/* OpenMP starts the calling thread's team at its first loop, when other work may have taken what was there: it is
 * started here, right after another look. */
static int start_team(int threads)
{
    if (threads < 2 || omp_in_parallel()) return threads;
    threads = try_threads(threads - 1) + 1;
#pragma omp parallel num_threads(threads)
    {
        __asm__ volatile("" ::: "memory"); /* an empty team would not be started */
    }
    return threads;
}

void threads_use_here(int count)
{
    bool first = settled.threads == 0;
    settled.change = atomic_load(&changes);
    settled.threads = grant(smaller(count, THREADS_MOST));
    if (first) settled.threads = start_team(settled.threads);
    omp_set_num_threads(settled.threads);
}

void threads_use(int count)
{
    atomic_store(&wanted, count);
    atomic_fetch_add(&changes, 1);
}

void threads_begin(void)
{
    int own = omp_get_max_threads();
    bool changed = settled.change != atomic_load(&changes);
    if (changed || settled.threads != own) threads_use_here(changed ? atomic_load(&wanted) : own);
}

merlin_status merlin_set_threads(int count)
{
    if (count < 1 || count > THREADS_MOST)
        return fail(MERLIN_WRONG_USE, "%d threads are not from 1 to %d", count, THREADS_MOST);
    threads_use(count);
    return MERLIN_OK;
}
