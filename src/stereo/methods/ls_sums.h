/* SPDX-License-Identifier: MIT */
/* Sums of a block of pixels over all pictures, for ls.c, limited only by the speed of memory.
 *
 *     ls_lights lights;
 *     status s = ls_lights_new(problem, &limits, &lights);
 *     ls_sums_add(&lights, first, count, &sums);     of one block; from any thread
 *     ls_lights_free(&lights);
 *
 * Pixels are processed together in vector registers and several pictures are added at once, so that the sums are loaded
 * and stored once for all of these; the next pictures' values are prefetched meanwhile. The right-hand sides need only
 * the values that count, which are recorded as one bit per picture: neighbours mostly have equal bits, and then the
 * matrix is made once for many pixels. */
#ifndef MERLIN_STEREO_METHODS_LS_SUMS_H
#define MERLIN_STEREO_METHODS_LS_SUMS_H

#include "stereo/fit/problem.h"

/* Pixels per block: the 11 sums of a pixel that every picture changes (11 KiB) and the current and next values (6 KiB)
 * stay in a first-level cache of 32 KiB. */
enum { LS_BLOCK = 256 };

typedef struct ls_sums {
    float matrix[6][LS_BLOCK];   /* Σ l lᵀ: xx, xy, xz, yy, yz, zz */
    float right[3][3][LS_BLOCK]; /* Σ v l: channel, component; channels that a grey picture lacks are zero */
    float square[LS_BLOCK];      /* Σ v² */
} ls_sums;

/* Limits in codes: a value counts if low < value (summed over all channels) and no channel reaches high. */
typedef struct ls_limits {
    float low, high;
} ls_limits;

typedef struct ls_lights ls_lights;

status ls_lights_new(const pst_problem *p, ls_limits limits, ls_lights **out);
void ls_lights_free(ls_lights *l);

/* Sums the pixels first .. first + count - 1, where count is at most LS_BLOCK. */
void ls_sums_add(const ls_lights *l, size_t first, int count, ls_sums *out);

#endif
