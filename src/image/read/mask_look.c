/* SPDX-License-Identifier: MIT */
#include "image/read/mask_look.h"

#include <math.h>

#include "image/read/read.h"

/* Distance from the darkest or brightest value, as a share of their difference, that counts as that value: lossy files
 * scatter. */
static const float NEAR = 0.1f;

/* Most other pixels, as a share of the rarer of the two values; a photograph of an object before black or white has far
 * more. */
static const double MOST_BETWEEN = 0.25;

status mask_look(const char *path, bool *is_two_valued)
{
    img grey;
    status s = img_read_grey(path, &grey);
    *is_two_valued = false;
    if (s != OK) return s == MERLIN_NO_MEMORY ? s : OK;
    size_t count = img_value_count(&grey), low = 0, high = 0;
    float least = grey.data[0], most = grey.data[0];
    for (size_t i = 0; i < count; i++) {
        least = fminf(least, grey.data[i]);
        most = fmaxf(most, grey.data[i]);
    }
    for (size_t i = 0; i < count; i++) {
        low += grey.data[i] - least <= NEAR * (most - least);
        high += most - grey.data[i] <= NEAR * (most - least);
    }
    img_free(&grey);
    *is_two_valued = most > least && (double)(count - low - high) <= MOST_BETWEEN * (double)(low < high ? low : high);
    return OK;
}
