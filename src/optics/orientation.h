/* SPDX-License-Identifier: MIT */
/* The eight orientations of a square frame, for augmentation. Camera, flash and frame are invariant under each, so that
 * a turned photograph is a photograph of the turned object.
 *
 *     to[orientation_place(o, size, i)] = from[i];    a picture
 *     orientation_turn(o, n);                         a normal, a light's position
 *     orientation_turn_sh(o, sh);                     an environment
 *     orientation_inverse(o)                          the orientation that undoes o
 */
#ifndef MERLIN_OPTICS_ORIENTATION_H
#define MERLIN_OPTICS_ORIENTATION_H

#include <stddef.h>

#include "optics/sh.h"

/* Bits of an orientation; flips are applied first. */
enum { ORIENTATION_FLIP_X = 1, ORIENTATION_FLIP_Y = 2, ORIENTATION_TRANSPOSE = 4, ORIENTATIONS = 8 };

/* Returns the pixel to which pixel i of size × size moves, row by row. */
static inline size_t orientation_place(int orientation, int size, size_t i)
{
    size_t side = (size_t)size, x = i % side, y = i / side;
    if (orientation & ORIENTATION_FLIP_X) x = side - 1 - x;
    if (orientation & ORIENTATION_FLIP_Y) y = side - 1 - y;
    return orientation & ORIENTATION_TRANSPOSE ? x * side + y : y * side + x;
}

/* Turns a vector. Rows run downwards and y upwards, so that exchanging rows and columns is (x, y) to (-y, -x). */
static inline void orientation_turn(int orientation, real v[3])
{
    if (orientation & ORIENTATION_FLIP_X) v[0] = -v[0];
    if (orientation & ORIENTATION_FLIP_Y) v[1] = -v[1];
    if (orientation & ORIENTATION_TRANSPOSE) {
        real t = v[0];
        v[0] = -v[1];
        v[1] = -t;
    }
}

static inline void orientation_turn_sh(int orientation, real sh[9][3])
{
    real columns[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, matrix[3][3];
    for (int j = 0; j < 3; j++) {
        orientation_turn(orientation, columns[j]);
        for (int i = 0; i < 3; i++)
            matrix[i][j] = columns[j][i];
    }
    sh_turn(sh, (const real(*)[3])matrix);
}

/* Returns the orientation that undoes this one. After a transposition a flip of x undoes one of y. */
static inline int orientation_inverse(int orientation)
{
    if (!(orientation & ORIENTATION_TRANSPOSE)) return orientation;
    int x = orientation & ORIENTATION_FLIP_X, y = orientation & ORIENTATION_FLIP_Y;
    return ORIENTATION_TRANSPOSE | (x ? ORIENTATION_FLIP_Y : 0) | (y ? ORIENTATION_FLIP_X : 0);
}

#endif
