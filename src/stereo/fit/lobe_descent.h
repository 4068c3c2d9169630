/* SPDX-License-Identifier: MIT */
/* Descends to the nearest minimum of one pixel's loss from a start. Internal to lobe_fit.c.
 *
 *     pst_shading found = pst_lobe_descend(&data, &lobe, &start, PST_DESCENT_NEAR, HUGE_VALF);
 *
 * The method is Gauss-Newton with Levenberg's damping under the redescending loss of Geman & McClure (1987), whose
 * scale is narrowed step by step as in pixel_fit.c. The unknowns are two angles of the normal, the albedo, the lobe's
 * height and the logarithm of its sharpness. */
#ifndef MERLIN_STEREO_FIT_LOBE_DESCENT_H
#define MERLIN_STEREO_FIT_LOBE_DESCENT_H

#include "stereo/fit/lobe.h"

/* Scale at which a descent from a distant start begins. */
#define PST_WIDEST 0.16f

typedef enum pst_descent { PST_DESCENT_FAR, PST_DESCENT_NEAR } pst_descent;

/* Returns the minimum, or stops early if it will hardly be below the limit; the result then costs more than the limit.
 */
pst_shading pst_lobe_descend(const pst_lobe_data *d, const pst_lobe *lobe, const pst_shading *start, pst_descent from,
                             float limit);

#endif
