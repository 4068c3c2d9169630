/* SPDX-License-Identifier: MIT */
/* One bar for all of a command's long work, with the remaining time: only on a terminal's standard error, drawn if the
 * work takes long, and removed when it ends, fails or is interrupted.
 *
 *     stage_bar bar;
 *     stage_bar_begin(&bar, quiet);
 *     stage_bar_plan(&bar, (const stage_cost[]){{"reading", 1}, {"solving", 4}}, 2);
 *     watch w = stage_bar_watch(&bar);
 *     ... work that is given &w ...
 *     stage_bar_end(&bar);                                    before anything is printed */
#ifndef MERLIN_CLI_STAGE_BAR_H
#define MERLIN_CLI_STAGE_BAR_H

#include <pthread.h>

#include "base/progress.h"
#include "base/watch.h"

/* Cost of a stage relative to the others, in any unit. */
typedef struct stage_cost {
    const char *name; /* stage's name as the watch gets it: a literal */
    double cost;
} stage_cost;

enum { STAGE_BAR_MOST = 8 };

typedef struct stage_bar {
    pthread_mutex_t lock;
    pthread_cond_t ended;
    pthread_t ticker; /* draws while nothing is reported */
    bool seen, ticking, ending;
    stage_cost stages[STAGE_BAR_MOST];
    size_t count;
    double from, to; /* span of the whole, for the plan */
    char item[32];
    const char *label;
    double began;
    pace pace;
    bool drawn, hidden;
} stage_bar;

void stage_bar_begin(stage_bar *b, bool quiet);
void stage_bar_end(stage_bar *b);
/* Plans all of the work, or the span that follows. Stages may be missing, and may repeat: a bar does not go back. */
void stage_bar_plan(stage_bar *b, const stage_cost *stages, size_t count);
/* Makes the following work this part of the whole, 0 <= from <= to <= 1: item number (from 1) of count. */
void stage_bar_span(stage_bar *b, double from, double to, size_t number, size_t count);
/* Removes the bar until the next report, so that other lines can be printed. */
void stage_bar_hide(stage_bar *b);
/* Returns a watch that reports to the bar, and stops when the command is interrupted. */
watch stage_bar_watch(stage_bar *b);

#endif
