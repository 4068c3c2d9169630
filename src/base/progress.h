/* SPDX-License-Identifier: MIT */
/* A progress bar with the time left on a terminal; elsewhere a plain line every ten seconds; silent with `quiet`.
 *
 * It is for work whose log is worth keeping: training, rendering, evaluation. Interactive commands use the bar of
 * cli/stage_bar.h, which is drawn by the same functions and leaves nothing behind. */
#ifndef MERLIN_BASE_PROGRESS_H
#define MERLIN_BASE_PROGRESS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/pace.h"

typedef struct progress {
    const char *label, *unit;
    size_t done, total;
    size_t first; /* amount done before this run, so that the rate of a resumed run is right */
    double started, shown;
    pace pace;
    bool quiet, terminal;
} progress;

void progress_begin(progress *p, const char *label, const char *unit, size_t done, size_t total, bool quiet);
/* Reports the amount done. note: a few words behind the bar, or NULL. Must be called by one thread at a time. */
void progress_update(progress *p, size_t done, const char *note);
void progress_end(progress *p);

/* Tells whether messages() is a terminal that can move its cursor. */
bool progress_is_seen(void);
/* Replaces the terminal's current line by a label, a bar of the share and some words; cut if the terminal is narrow. */
void progress_draw(const char *label, double share, const char *words);
/* Clears the line and puts the cursor at its beginning. */
void progress_clear(void);

/* Room for a duration such as "0:07" or "1:02:03". */
enum { PROGRESS_TIME = 32 };
void progress_time(double seconds, char out[PROGRESS_TIME]);

/* Returns the monotonic clock's seconds. */
double clock_seconds(void);

#endif
