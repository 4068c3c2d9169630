/* SPDX-License-Identifier: MIT */
#include "image/coverage.h"

bool coverage_is_opaque(const img *mask)
{
    for (size_t i = 0; i < img_value_count(mask); i++)
        if (!(mask->data[i] > COVERAGE_WHOLE)) return false;
    return true;
}

bool coverage_is_transparent(const img *mask)
{
    for (size_t i = 0; i < img_value_count(mask); i++)
        if (mask->data[i] >= 0.5f) return false;
    return true;
}

coverage_box coverage_box_of(const img *mask)
{
    coverage_box b = {mask->width, mask->height, 0, 0, 0};
    for (int y = 0; y < mask->height; y++)
        for (int x = 0; x < mask->width; x++) {
            if (!(*img_at(mask, x, y) >= 0.5f)) continue;
            b.pixels++;
            if (x < b.left) b.left = x;
            if (x >= b.right) b.right = x + 1;
            if (y < b.top) b.top = y;
            b.bottom = y + 1;
        }
    return b;
}
