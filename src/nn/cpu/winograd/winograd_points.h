/* SPDX-License-Identifier: MIT */
/* Squares of values to the 36 points of F(4×4, 3×3) and back, for a register of channels at once. Internal to
 * winograd.h. */
#ifndef MERLIN_NN_CPU_WINOGRAD_WINOGRAD_POINTS_H
#define MERLIN_NN_CPU_WINOGRAD_WINOGRAD_POINTS_H

#include "nn/cpu/winograd/winograd_lines.h"
#include "nn/nn.h"

/* Sides of a tile of the result, of its window of the input and of the kernel; numbers of values of the last two. */
enum { TILE = 4, WINDOW = 6, KERNEL = 3, POINTS = WINDOW * WINDOW, TAPS = KERNEL * KERNEL };

/* Pixels of `type`, channels side by side; row: elements from one row to the next. */
typedef struct square {
    const void *first;
    size_t row;
} square;

ALWAYS_INLINE void wide_read(wide *v, const void *from, size_t at, const nn_type type)
{
    if (type == NN_FLOAT32)
        wide_load(v, (const float *)from + at);
    else
        wide_widen(v, (const uint16_t *)from + at);
}

ALWAYS_INLINE void wide_write(const wide *v, void *to, size_t at, const nn_type type)
{
    if (type == NN_FLOAT32)
        wide_store(v, (float *)to + at);
    else
        wide_narrow(v, (uint16_t *)to + at);
}

/* Maps a square, from its channel c on, to points that are `stride` floats apart. pixel: elements from one pixel to the
 * next; its type, side and map are constants in every caller. */
ALWAYS_INLINE void to_points(square from, const nn_type type, size_t c, size_t pixel, const size_t side, line_map map,
                             float *to, size_t stride)
{
    wide half[WINDOW][WINDOW];
    for (size_t j = 0; j < side; j++) {
        wide column[WINDOW], mapped[WINDOW];
#pragma GCC unroll 6
        for (size_t i = 0; i < side; i++)
            wide_read(&column[i], from.first, i * from.row + j * pixel + c, type);
        map(column, mapped);
#pragma GCC unroll 6
        for (size_t i = 0; i < WINDOW; i++)
            half[i][j] = mapped[i];
    }
    for (size_t i = 0; i < WINDOW; i++) {
        wide mapped[WINDOW];
        map(half[i], mapped);
#pragma GCC unroll 6
        for (size_t j = 0; j < WINDOW; j++)
            wide_store(&mapped[j], to + (i * WINDOW + j) * stride);
    }
}

/* Maps points back to side × side values. */
ALWAYS_INLINE void from_points(const float *from, size_t stride, const size_t side, line_map map, wide *to)
{
    wide half[WINDOW][WINDOW];
    for (size_t j = 0; j < WINDOW; j++) {
        wide column[WINDOW], mapped[WINDOW];
#pragma GCC unroll 6
        for (size_t i = 0; i < WINDOW; i++)
            wide_load(&column[i], from + (i * WINDOW + j) * stride);
        map(column, mapped);
#pragma GCC unroll 6
        for (size_t i = 0; i < side; i++)
            half[i][j] = mapped[i];
    }
#pragma GCC unroll 6
    for (size_t i = 0; i < side; i++)
        map(half[i], to + i * side);
}

#endif
