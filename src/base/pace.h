/* SPDX-License-Identifier: MIT */
/* How long work will still take, by how quickly it went of late.
 *
 *     pace p;
 *     pace_begin(&p, 0, clock_seconds());
 *     pace_note(&p, 0.25, clock_seconds());                a quarter is done
 *     double seconds = pace_left(&p, clock_seconds());
 *
 * The pace is a mean over what was done, each part weighing less the more was done since: a machine that others use
 * for a while is forgotten, and one step that is quicker than the others changes little. */
#ifndef MERLIN_BASE_PACE_H
#define MERLIN_BASE_PACE_H

typedef struct pace {
    double share, at;     /* what was done when it was last heard of, in [0, 1], and the time then in seconds */
    double done, seconds; /* of late: a share, and how long it took */
} pace;

/* share: what is done already, which costs nothing: it does not count as speed. */
void pace_begin(pace *p, double share, double now);
/* A share that is not above the last one is no news. */
void pace_note(pace *p, double share, double now);
/* Seconds from now, 0 at least; below 0 as long as nothing was heard of. They pass while nothing is heard of. */
double pace_left(const pace *p, double now);

#endif
