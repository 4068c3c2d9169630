/* SPDX-License-Identifier: MIT */
#include "base/threads.h"

#include <omp.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <unistd.h>

#include "base/number.h"
#include "base/status.h"

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER; /* guards the variables below */
static int tried, had; /* tried: most threads that were asked for; had: how many of them the system granted */
static bool sleepers_started;

static atomic_int wanted; /* set by threads_use; 0: OpenMP's own choice */
static atomic_uint changes;

/* The calling thread's setting: its number of threads, and the last change of `wanted` that it has applied. */
static _Thread_local struct {
    int threads;
    unsigned change;
} settled;

/* ---- how many threads the system grants ---- */

static void *wait_for_all(void *gate)
{
    pthread_mutex_lock(gate);
    pthread_mutex_unlock(gate);
    return NULL;
}

/* Starts `count` threads at once, with stacks as large as OpenMP's, and ends them again; returns how many could start.
 * Asks for no memory, which would be taken for a lack of threads from then on. */
static int try_threads(int count)
{
    enum { MOST = 4 * THREADS_MOST };
    pthread_mutex_t gate = PTHREAD_MUTEX_INITIALIZER;
    pthread_t thread[MOST];
    int started = 0, most = min_int(count, MOST);
    pthread_mutex_lock(&gate);
    while (started < most && pthread_create(&thread[started], NULL, wait_for_all, &gate) == 0)
        started++;
    pthread_mutex_unlock(&gate);
    for (int i = 0; i < started; i++)
        pthread_join(thread[i], NULL);
    return started;
}

bool threads_are_left(int count)
{
    return try_threads(count) == count;
}

/* ---- how idle threads wait ---- */

/* Keeps a second OpenMP team asleep for the program's lifetime. libgomp's idle threads spin for milliseconds (300,000
 * rounds) before they sleep, unless there are more OpenMP threads than processors: then for 1000 rounds, some tens of
 * microseconds. The long spin takes processors from other work (docs/notes/waiting_threads.md). It can be shortened by
 * the environment, but that is read before main starts, so that this team makes the threads outnumber the processors
 * instead. */
static void *sleep_for_good(void *team)
{
#pragma omp parallel num_threads((int)(intptr_t)team)
    {
        __asm__ volatile("" ::: "memory"); /* an empty region would not start the team */
    }
    while (pause() < 0) /* pause always returns -1 */
        ;
    return NULL;
}

static void start_sleepers(int team)
{
    sigset_t all, before;
    pthread_t sleeper;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before); /* leave signals to the program's own threads */
    if (pthread_create(&sleeper, NULL, sleep_for_good, (void *)(intptr_t)team) == 0) pthread_detach(sleeper);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
}

/* Tells whether the environment says how threads are to wait, which then holds. */
static bool waiting_is_chosen(void)
{
    return getenv("GOMP_SPINCOUNT") || getenv("OMP_WAIT_POLICY");
}

/* ---- applying both ---- */

/* Returns the size of the sleeping team with which OpenMP's threads outnumber the processors beside a loop of `threads`
 * threads. */
static int team_beside(int threads)
{
    int processors = omp_get_num_procs();
    return threads < processors ? processors - threads + 2 : 2;
}

/* Returns the number of threads for two such loops at once, as a second thread reads photographs ahead; one more
 * converts weights ahead. */
static int needed_for(int threads)
{
    return 2 * (threads - 1) + 2;
}

/* Returns the largest number up to `count` for which `found` threads suffice, and whether the sleeping team fits, too.
 */
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

/* Returns `count`, or as many threads as the system grants. */
static int grant(int count)
{
    if (count < 2) return 1;
    pthread_mutex_lock(&lock);
    if (count > tried) find_out(count);
    int threads = min_int(count, had);
    pthread_mutex_unlock(&lock);
    return threads;
}

/* Starts the calling thread's OpenMP team right after checking again how many threads there are: OpenMP would start it
 * at the first loop, when other work may have taken them. */
static int start_team(int threads)
{
    if (threads < 2 || omp_in_parallel()) return threads;
    threads = try_threads(threads - 1) + 1;
#pragma omp parallel num_threads(threads)
    {
        __asm__ volatile("" ::: "memory"); /* an empty region would not start the team */
    }
    return threads;
}

void threads_use_here(int count)
{
    bool first = settled.threads == 0;
    settled.change = atomic_load(&changes);
    settled.threads = grant(min_int(count, THREADS_MOST));
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
