/* SPDX-License-Identifier: MIT */
/* Matrix products for Winograd's filtering: many rows, a panel a few registers wide, both operands in place. Internal
 * to winograd.c. */
#ifndef MERLIN_NN_CPU_WINOGRAD_WINOGRAD_PRODUCT_H
#define MERLIN_NN_CPU_WINOGRAD_WINOGRAD_PRODUCT_H

#include <stdbool.h>
#include <stddef.h>

#include "nn/cpu/winograd/winograd_lines.h"

enum { WINOGRAD_PANEL = 2 * WIDE };

/* Rows of c = a b, or c += a b, one panel wide: a has `depth` values a row, b a row of the panel for each of them. */
typedef struct winograd_product {
    const float *a, *b;
    float *c;
    size_t a_row, a_next, b_next, c_row; /* distances in floats */
    int depth;
    bool add;
} winograd_product;

/* Computes `rows` rows of a panel that is `width` values wide: WIDE or WINOGRAD_PANEL. */
void winograd_multiply(winograd_product p, size_t rows, size_t width);

#endif
