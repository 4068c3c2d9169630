/* SPDX-License-Identifier: MIT */
/* A watch tells how far long work is to whoever waits for it. Libraries take one and never print:
 *
 *     watch_tell(w, "solving", 0.4);                                    w may be NULL
 *     if (watch_stops(w)) return fail(MERLIN_STOPPED, "stopped"); */
#ifndef MERLIN_BASE_WATCH_H
#define MERLIN_BASE_WATCH_H

#include <stdbool.h>
#include <stddef.h>

typedef struct watch {
    /* what: the stage, a literal; share of it that is done, in [0, 1]. Called from one thread at a time,
     * the one that began the work. */
    void (*tell)(void *context, const char *what, double share);
    void *context;
    int (*stop)(void); /* nonzero: whoever waits gave up; may be NULL. Any thread */
} watch;

static inline void watch_tell(const watch *w, const char *what, double share)
{
    if (w) w->tell(w->context, what, share);
}

static inline bool watch_stops(const watch *w)
{
    return w && w->stop && w->stop();
}

#endif
