/* SPDX-License-Identifier: MIT */
/* A progress bar with the time left, on a terminal; a plain line every ten seconds elsewhere; silent if told so.
 *
 * That is for work whose log is worth keeping: training, rendering, evaluation. What people wait for at a terminal has
 * the bar of cli/stage_bar.h, which is drawn by the same functions and leaves nothing behind. */
#ifndef MERLIN_BASE_PROGRESS_H
#define MERLIN_BASE_PROGRESS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/pace.h"

typedef struct progress {
    const char *label, *unit;
    size_t done, total;
    size_t first; /* what was already done when the work began, so that a resumed run's rate is right */
    double started, shown;
    pace pace;
    bool quiet, terminal;
} progress;

void progress_begin(progress *p, const char *label, const char *unit, size_t done, size_t total, bool quiet);
/* note: a few words shown behind the bar, or NULL. Call from one thread at a time. */
void progress_update(progress *p, size_t done, const char *note);
void progress_end(progress *p);

/* Whether messages() leads to a terminal that moves its cursor. */
bool progress_is_seen(void);
/* One line of the terminal, in place of what stands there: label, a bar of the share, words behind it. It is cut where
 * the terminal is narrow. */
void progress_draw(const char *label, double share, const char *words);
/* An empty line, with the cursor at its beginning. */
void progress_clear(void);

/* "0:07", "1:02:03". */
enum { PROGRESS_TIME = 32 };
void progress_time(double seconds, char out[PROGRESS_TIME]);

/* Seconds on the monotonic clock. */
double clock_seconds(void);

#endif
