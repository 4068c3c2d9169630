/* SPDX-License-Identifier: MIT */
/* Divides a picture into two parts at the least cost: exact minimum cut of a grid whose pixels are linked to their
 * eight neighbours.
 *
 *     grid_cut g;
 *     status s = grid_cut_new(&g, width, height);
 *     ... g.toward[i] = cost of calling pixel i background, minus cost of calling it object ...
 *     ... g.tie[GRID_RIGHT][i] = cost of separating pixel i from the one to its right ...
 *     if (s == OK) s = grid_cut_solve(&g, object);      object[i] becomes 0 or 1
 *     grid_cut_free(&g);
 *
 * The method is that of augmenting paths between two search trees (Boykov & Kolmogorov 2004). Costs are integers, so
 * that the result is exact and the same on every machine. */
#ifndef MERLIN_ESTIMATE_OBJECT_GRID_CUT_H
#define MERLIN_ESTIMATE_OBJECT_GRID_CUT_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

/* Opposite directions differ in the last bit. */
typedef enum grid_direction {
    GRID_RIGHT,
    GRID_LEFT,
    GRID_DOWN,
    GRID_UP,
    GRID_DOWN_RIGHT,
    GRID_UP_LEFT,
    GRID_DOWN_LEFT,
    GRID_UP_RIGHT,
    GRID_DIRECTIONS
} grid_direction;

/* A grid and its costs. Pixels that are not free keep their side in `object`. */
typedef struct grid_cut {
    int width, height;
    int32_t *toward;               /* cost difference of each pixel, as above */
    int32_t *tie[GRID_DIRECTIONS]; /* costs, not negative; the caller sets right, down, down right and down left */
    uint8_t *free;                 /* 1 for pixels to be decided; all are at first */
    void *memory, *work;           /* memory of all cuts, and of the next grid_cut_solve */
} grid_cut;

status grid_cut_new(grid_cut *out, int width, int height);
void grid_cut_free(grid_cut *g);
/* Finds the minimum cut; among equal ones, that with the smallest object. */
status grid_cut_solve(grid_cut *g, uint8_t *object);

/* Returns the neighbour of pixel i in a direction, or SIZE_MAX outside the picture. */
static inline size_t grid_beside(int width, int height, size_t i, int direction)
{
    static const int dx[GRID_DIRECTIONS] = {1, -1, 0, 0, 1, -1, -1, 1};
    static const int dy[GRID_DIRECTIONS] = {0, 0, 1, -1, 1, -1, 1, -1};
    int x = (int)(i % (size_t)width) + dx[direction], y = (int)(i / (size_t)width) + dy[direction];
    if (x < 0 || y < 0 || x >= width || y >= height) return SIZE_MAX;
    return (size_t)y * (size_t)width + (size_t)x;
}

#endif
