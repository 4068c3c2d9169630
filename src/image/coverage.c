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

static size_t covered(const img *mask, int x, int y, int step_x, int step_y, int count)
{
    size_t sum = 0;
    for (int i = 0; i < count; i++)
        sum += *img_at(mask, x + i * step_x, y + i * step_y) >= 0.5f;
    return sum;
}

float coverage_of_edge(const img *mask)
{
    const int w = mask->width, h = mask->height;
    const size_t edge = covered(mask, 0, 0, 1, 0, w) + covered(mask, 0, h - 1, 1, 0, w) + covered(mask, 0, 0, 0, 1, h) +
                        covered(mask, w - 1, 0, 0, 1, h);
    return (float)edge / (float)(2 * (w + h));
}
