/* SPDX-License-Identifier: MIT */
/* Estimates the time that work will still take from its recent speed.
 *
 *     pace p;
 *     pace_begin(&p, 0, clock_seconds());
 *     pace_note(&p, 0.25, clock_seconds());                a quarter is done
 *     double seconds = pace_left(&p, clock_seconds());
 *
 * The speed is a mean over the work done so far, weighted toward the most recent: a machine that was busy for a while
 * is forgotten, and a single fast step changes little. */
#ifndef MERLIN_BASE_PACE_H
#define MERLIN_BASE_PACE_H

typedef struct pace {
    double share, at;     /* share: done when last noted, in [0, 1]; at: the time of that note, seconds */
    double done, seconds; /* decaying sums: share done, and the seconds it took */
} pace;

/* Begins at a share that was done before: it took no time, and does not count as speed. */
void pace_begin(pace *p, double share, double now);
/* Notes the share done at a time. A share not above the last one is ignored. */
void pace_note(pace *p, double share, double now);
/* Returns the seconds left from now, at least 0; negative as long as nothing was noted. The estimate counts down
 * between notes. */
double pace_left(const pace *p, double now);

#endif
