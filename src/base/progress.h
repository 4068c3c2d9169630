/* A progress bar with the time left, on a terminal; a plain line every ten seconds elsewhere; silent if told so. */
#ifndef MERLIN_BASE_PROGRESS_H
#define MERLIN_BASE_PROGRESS_H

#include <stdbool.h>
#include <stddef.h>

typedef struct progress {
    const char *label, *unit;
    size_t done, total;
    size_t first; /* what was already done when the work began, so that a resumed run's rate is right */
    double started, shown;
    bool quiet, terminal;
} progress;

void progress_begin(progress *p, const char *label, const char *unit, size_t done, size_t total, bool quiet);
/* note: a few words shown behind the bar, or NULL. Call from one thread at a time. */
void progress_update(progress *p, size_t done, const char *note);
void progress_end(progress *p);

/* Seconds on the monotonic clock. */
double clock_seconds(void);

#endif
