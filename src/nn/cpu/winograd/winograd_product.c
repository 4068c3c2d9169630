/* SPDX-License-Identifier: MIT */
#include "nn/cpu/winograd/winograd_product.h"

/* Multiplies a fixed number of rows; rows, and registers side by side, are constants in every caller. */
ALWAYS_INLINE void multiply_rows(const winograd_product *p, const int rows, const int across)
{
    wide sum[WINOGRAD_ROWS][2];
#pragma GCC unroll 12
    for (int r = 0; r < rows; r++)
#pragma GCC unroll 2
        for (int i = 0; i < across; i++) {
            sum[r][i] = (wide){0};
            if (p->add) wide_load(&sum[r][i], p->c + (size_t)r * p->c_row + (size_t)i * WIDE);
        }
    const float *a = p->a, *b = p->b;
    for (int k = 0; k < p->depth; k++, a += p->a_next, b += p->b_next) {
        wide panel[2];
#pragma GCC unroll 2
        for (int i = 0; i < across; i++)
            wide_load(&panel[i], b + i * WIDE);
#pragma GCC unroll 12
        for (int r = 0; r < rows; r++) {
            float v = a[(size_t)r * p->a_row];
#pragma GCC unroll 2
            for (int i = 0; i < across; i++)
                sum[r][i] += v * panel[i];
        }
    }
#pragma GCC unroll 12
    for (int r = 0; r < rows; r++)
#pragma GCC unroll 2
        for (int i = 0; i < across; i++)
            wide_store(&sum[r][i], p->c + (size_t)r * p->c_row + (size_t)i * WIDE);
}

/* Multiplies fewer rows than WINOGRAD_ROWS. */
ALWAYS_INLINE void multiply_rest(const winograd_product *p, size_t rows, const int across)
{
#define CASE(n)                                                                                                        \
    case n:                                                                                                            \
        multiply_rows(p, n, across);                                                                                   \
        break
    switch (rows) {
        CASE(1);
        CASE(2);
        CASE(3);
        CASE(4);
        CASE(5);
#if defined(__AVX512F__)
        CASE(6);
        CASE(7);
        CASE(8);
        CASE(9);
        CASE(10);
        CASE(11);
#endif
    default:
        break;
    }
#undef CASE
}

ALWAYS_INLINE void multiply_panel(winograd_product *p, size_t rows, const int across)
{
    for (; rows >= WINOGRAD_ROWS; rows -= WINOGRAD_ROWS) {
        multiply_rows(p, WINOGRAD_ROWS, across);
        p->a += WINOGRAD_ROWS * p->a_row;
        p->c += WINOGRAD_ROWS * p->c_row;
    }
    multiply_rest(p, rows, across);
}

void winograd_multiply(winograd_product p, size_t rows, size_t width)
{
    if (width > WIDE)
        multiply_panel(&p, rows, 2);
    else
        multiply_panel(&p, rows, 1);
}
