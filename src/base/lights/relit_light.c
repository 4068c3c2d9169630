/* SPDX-License-Identifier: MIT */
#include "base/lights/relit_light.h"

#include <math.h>
#include <stdio.h>

/* Least linear value that is told from black on a screen: 8 of 255 in an 8-bit file. */
static const float LEAST_SEEN = 8.0f / 255 / 12.92f;
static const double LITTLE_LIT = 0.01, MUCH_BURNT_OUT = 0.05;

void relit_light_note(relit_light *seen, const merlin_image *picture, const merlin_image *mask)
{
    size_t burnt = 0, lit = 0, count = 0;
    for (size_t i = 0; i < (size_t)mask->width * (size_t)mask->height; i++) {
        const float *value = picture->data + 3 * i;
        if (mask->data[i] < 0.5f) continue;
        burnt += value[0] >= 1 || value[1] >= 1 || value[2] >= 1;
        lit += value[0] >= LEAST_SEEN || value[1] >= LEAST_SEEN || value[2] >= LEAST_SEEN;
        count++;
    }
    const double share = count ? (double)burnt / (double)count : 0;
    seen->burnt_out = fmax(seen->burnt_out, share);
    seen->burnt += share >= MUCH_BURNT_OUT;
    seen->dark += (double)lit < LITTLE_LIT * (double)count;
    seen->pictures++;
}

static void warn_of_darkness(const relit_light *seen, warnings *list)
{
    char which[64] = "the picture";
    if (seen->pictures > 1) snprintf(which, sizeof which, "%zu of %zu pictures", seen->dark, seen->pictures);
    warnings_add(list, "nothing_lit",
                 "the object is black in %s: lamps light what faces them, from in front of 0,0,-1, where it is; or the "
                 "exposure is too low",
                 which);
}

void relit_light_warn(const relit_light *seen, const char *remedy, warnings *list)
{
    char of_several[96] = "";
    if (seen->dark) warn_of_darkness(seen, list);
    if (seen->burnt == 0) return;
    if (seen->pictures > 1)
        snprintf(of_several, sizeof of_several, " at most, %zu of %zu pictures more than %.0f %%", seen->burnt,
                 seen->pictures, 100 * MUCH_BURNT_OUT);
    warnings_add(list, "relit_burnt_out", "%.0f %% of the object is burnt out when relit%s: darken it by %s",
                 100 * seen->burnt_out, of_several, remedy);
}

void relit_light_warn_negative(double share, warnings *list)
{
    if (share > 0)
        warnings_add(list, "environment_values",
                     "%.3g %% of the surroundings' values are negative, and were taken for black", 100 * share);
}
