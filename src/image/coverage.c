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
