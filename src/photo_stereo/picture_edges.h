/* SPDX-License-Identifier: MIT */
/* The edges of a capture's pictures at some size, by which they are aligned, as light changes all else.
 *
 *     edge_level l;
 *     status s = edge_level_new(capture, shifts, 128, &l);
 *     ... edges of some pictures are added up, and those of others compared with the sum ...
 *     edge_level_free(&l); */
#ifndef MERLIN_PHOTO_STEREO_PICTURE_EDGES_H
#define MERLIN_PHOTO_STEREO_PICTURE_EDGES_H

#include <stdlib.h>

#include "stereo/capture/capture.h"

/* Pixels to the right and down. */
typedef struct shift {
    int x, y;
} shift;

static inline shift shift_sum(shift a, shift b)
{
    return (shift){a.x + b.x, a.y + b.y};
}

static inline shift shift_between(shift a, shift b)
{
    return (shift){b.x - a.x, b.y - a.y};
}

/* Returns the larger of its two components. */
static inline int shift_reach(shift a)
{
    return abs(a.x) > abs(a.y) ? abs(a.x) : abs(a.y);
}

/* The part of a row or column that stays in the picture when it is shifted: its first pixel, and the one behind it. */
static inline int shift_first(int by)
{
    return by < 0 ? -by : 0;
}

static inline int shift_end(int by, int size)
{
    return by > 0 ? size - by : size;
}

/* The pictures at one size. */
typedef struct edge_level {
    const merlin_capture *capture;
    int width, height;
    img *edges;    /* of each picture, 1 channel */
    img mask, sum; /* where edges are compared; the sum of those of the pictures that are compared with, as shifted */
    shift *by;     /* of each picture */
} edge_level;

/* Two pictures' edges are alike if their correlation is at least this. A shadow's edge lies elsewhere in each picture:
 * those of a plain ball under eight lights reach 0.6, pictures that moved by four pixels 0.25 to 0.5 before they are
 * shifted back. */
static const double edges_alike = 0.5;

enum { EDGE_MOST_REACH = 16 };

/* Shifts that are tried of one picture, (2 · reach + 1)² of them around `start`. */
typedef struct edge_trials {
    const edge_level *level;
    int picture, reach;
    shift start;
    double likeness[(2 * EDGE_MOST_REACH + 1) * (2 * EDGE_MOST_REACH + 1)];
} edge_trials;

/* Makes the edges of this longer side; the sum is zero. by: the shifts, one for each picture, which the caller keeps.
 * Call edge_level_free after a failure, too. */
status edge_level_new(const merlin_capture *capture, shift *by, int longest, edge_level *out);
void edge_level_free(edge_level *l);

/* Adds a picture's edges, shifted back, to the sum of all that are compared with. */
void edge_level_add(edge_level *l, int k, float weight);

/* Returns the correlation, within the mask, of a picture's edges, shifted back, with the sum of the others'. */
double edge_level_likeness(const edge_level *l, int k, shift by);

/* Finds how alike each of the shifts is, in parallel, and returns their number. */
size_t edge_trials_run(edge_trials *t);

/* Returns the shift that is tried at an index. */
shift edge_trials_at(const edge_trials *t, size_t i);

/* The longer side of a capture's pictures. */
int edge_longer_side(const merlin_capture *c);

#endif
