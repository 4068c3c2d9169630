/* SPDX-License-Identifier: MIT */
#include "cli/stage_bar.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "command/cli.h"

/* Times in seconds. Work shorter than LONG has no bar, nor has work nearly finished then; without any report of
 * progress the bar appears slightly earlier, so that a terminal is not silent for long. Estimates from the first
 * moments are unreliable. */
static const double LONG = 2, UNHEARD = 1.5, MOMENTS = 0.5;
enum { TICK_NANOSECONDS = 200000000, SECOND_NANOSECONDS = 1000000000 };

/* ---- drawing; the lock is held ---- */

static void take_away(stage_bar *b)
{
    if (b->drawn) progress_clear();
    b->drawn = false;
}

static bool is_long(const stage_bar *b, double elapsed, double left)
{
    if (b->drawn) return true;
    if (left < 0) return elapsed >= UNHEARD;
    return elapsed >= MOMENTS && elapsed + left >= LONG && (left >= MOMENTS || elapsed >= LONG + MOMENTS);
}

static void draw(stage_bar *b)
{
    double now = clock_seconds(), left = pace_left(&b->pace, now);
    if (!b->label || b->hidden || !is_long(b, now - b->began, left)) return;
    char time[PROGRESS_TIME] = "?", words[96];
    if (left >= 0) progress_time(fmax(left, 1), time); /* running work never shows zero */
    snprintf(words, sizeof words, "%3.0f %%  %s%s left", floor(100 * b->pace.share), b->item, time);
    progress_draw(b->label, b->pace.share, words);
    b->drawn = true;
}

static void *tick(void *bar)
{
    stage_bar *b = bar;
    pthread_mutex_lock(&b->lock);
    while (!b->ending) {
        struct timespec until;
        clock_gettime(CLOCK_MONOTONIC, &until);
        until.tv_nsec += TICK_NANOSECONDS;
        until.tv_sec += until.tv_nsec / SECOND_NANOSECONDS;
        until.tv_nsec %= SECOND_NANOSECONDS;
        if (pthread_cond_timedwait(&b->ended, &b->lock, &until) != ETIMEDOUT) continue;
        if (cli_interrupted())
            take_away(b);
        else
            draw(b);
    }
    pthread_mutex_unlock(&b->lock);
    return NULL;
}

/* ---- what is done ---- */

/* Returns the share of the whole for a share of a stage; unplanned stages do not move the bar. */
static double whole_share(const stage_bar *b, const char *stage, float share)
{
    double done = -1, all = 0;
    for (size_t i = 0; i < b->count; i++) {
        if (strcmp(b->stages[i].name, stage) == 0) done = all + (double)share * b->stages[i].cost;
        all += b->stages[i].cost;
    }
    return done < 0 || !(all > 0) ? b->pace.share : b->from + (b->to - b->from) * done / all;
}

static void tell(void *bar, const char *stage, float share)
{
    stage_bar *b = bar;
    if (!b->seen) return;
    pthread_mutex_lock(&b->lock);
    b->label = stage;
    b->hidden = false;
    pace_note(&b->pace, whole_share(b, stage, share), clock_seconds());
    pthread_mutex_unlock(&b->lock);
}

watch stage_bar_watch(stage_bar *b)
{
    return (watch){tell, b, cli_interrupted};
}

void stage_bar_plan(stage_bar *b, const stage_cost *stages, size_t count)
{
    b->count = count < STAGE_BAR_MOST ? count : STAGE_BAR_MOST;
    memcpy(b->stages, stages, b->count * sizeof *stages);
}

void stage_bar_span(stage_bar *b, double from, double to, size_t number, size_t count)
{
    if (!b->seen) return;
    pthread_mutex_lock(&b->lock); /* the ticker reads the item */
    b->from = from;
    b->to = to;
    b->item[0] = 0;
    if (count > 1) snprintf(b->item, sizeof b->item, "%zu/%zu  ", number, count);
    pthread_mutex_unlock(&b->lock);
}

/* ---- from begin to end ---- */

/* Starts the ticker; without memory or a thread there is no bar, and the work continues. */
static bool start(stage_bar *b)
{
    pthread_condattr_t monotonic;
    if (pthread_mutex_init(&b->lock, NULL) != 0) return false;
    pthread_condattr_init(&monotonic);
    pthread_condattr_setclock(&monotonic, CLOCK_MONOTONIC);
    bool made = pthread_cond_init(&b->ended, &monotonic) == 0;
    pthread_condattr_destroy(&monotonic);
    b->ticking = made && pthread_create(&b->ticker, NULL, tick, b) == 0;
    if (b->ticking) return true;
    if (made) pthread_cond_destroy(&b->ended);
    pthread_mutex_destroy(&b->lock);
    return false;
}

void stage_bar_begin(stage_bar *b, bool quiet)
{
    *b = (stage_bar){.to = 1, .began = clock_seconds()};
    pace_begin(&b->pace, 0, b->began);
    b->seen = !quiet && progress_is_seen() && start(b);
}

void stage_bar_hide(stage_bar *b)
{
    if (!b->seen) return;
    pthread_mutex_lock(&b->lock);
    take_away(b);
    b->hidden = true;
    pthread_mutex_unlock(&b->lock);
}

void stage_bar_end(stage_bar *b)
{
    if (!b->seen) return;
    pthread_mutex_lock(&b->lock);
    b->ending = true;
    pthread_cond_signal(&b->ended);
    pthread_mutex_unlock(&b->lock);
    pthread_join(b->ticker, NULL);
    take_away(b);
    pthread_cond_destroy(&b->ended);
    pthread_mutex_destroy(&b->lock);
    b->seen = false;
}
