/* SPDX-License-Identifier: MIT */
/* Parts a picture in two at the least cost: exact minimum cut of a grid whose pixels are tied to their eight
 * neighbours.
 *
 *     grid_cut g;
 *     status s = grid_cut_new(&g, width, height);
 *     ... g.toward[i] = what it costs to call pixel i background, less what it costs to call it object ...
 *     ... g.tie[GRID_RIGHT][i] = what it costs to part pixel i from the one to its right ...
 *     if (s == OK) s = grid_cut_solve(&g, object);      object[i] becomes 0 or 1
 *     grid_cut_free(&g);
 *
 * Augmenting paths of two search trees (Boykov & Kolmogorov 2004). Costs are whole numbers, so that the answer is exact
 * and the same everywhere. */
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

/* Pixels that are not free keep the side that they have in `object`. */
typedef struct grid_cut {
    int width, height;
    int32_t *toward;               /* of each pixel */
    int32_t *tie[GRID_DIRECTIONS]; /* not negative; the four that are set are right, down, down right, down left */
    uint8_t *free;                 /* 1 at first, everywhere */
    void *memory, *work;           /* work: of the next grid_cut_solve */
} grid_cut;

status grid_cut_new(grid_cut *out, int width, int height);
void grid_cut_free(grid_cut *g);
/* Of equal cuts the one with the smallest object. */
status grid_cut_solve(grid_cut *g, uint8_t *object);

/* Returns the pixel in a direction of pixel i, or SIZE_MAX beside the picture. */
static inline size_t grid_beside(int width, int height, size_t i, int direction)
{
    static const int dx[GRID_DIRECTIONS] = {1, -1, 0, 0, 1, -1, -1, 1};
    static const int dy[GRID_DIRECTIONS] = {0, 0, 1, -1, 1, -1, 1, -1};
    int x = (int)(i % (size_t)width) + dx[direction], y = (int)(i / (size_t)width) + dy[direction];
    if (x < 0 || y < 0 || x >= width || y >= height) return SIZE_MAX;
    return (size_t)y * (size_t)width + (size_t)x;
}

#endif
