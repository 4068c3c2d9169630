/* SPDX-License-Identifier: MIT */
/* A watch reports the progress of long work to the caller. Libraries take one, and never print:
 *
 *     watch_tell(w, "solving", 0.4);                                    w may be NULL
 *     if (watch_stops(w)) return fail(MERLIN_STOPPED, "stopped");
 */
#ifndef MERLIN_BASE_WATCH_H
#define MERLIN_BASE_WATCH_H

#include <stdbool.h>
#include <stddef.h>

#include "merlin/status.h"

typedef struct watch {
    merlin_progress tell; /* NULL: progress is not reported; `stage` is a literal; called by one thread at a time */
    void *context;
    int (*stop)(void); /* returns nonzero to stop the work; may be NULL; may be called from any thread */
} watch;

static inline void watch_tell(const watch *w, const char *stage, double share)
{
    if (w && w->tell) w->tell(w->context, stage, (float)share);
}

static inline bool watch_stops(const watch *w)
{
    return w && w->stop && w->stop();
}

#endif
