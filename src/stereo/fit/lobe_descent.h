/* SPDX-License-Identifier: MIT */
/* Down to the nearest minimum of one pixel's loss, from a start. Internal to lobe_fit.c.
 *
 *     pst_shading found = pst_lobe_descend(&data, &lobe, &start, PST_DESCENT_NEAR, HUGE_VALF);
 *
 * Gauss-Newton with Levenberg's damping under the redescending loss of Geman & McClure (1987), its scale narrowed step
 * by step as in pixel_fit.c. The unknowns are two angles of the normal, the albedo, the lobe's height and the logarithm
 * of its sharpness. */
#ifndef MERLIN_STEREO_FIT_LOBE_DESCENT_H
#define MERLIN_STEREO_FIT_LOBE_DESCENT_H

#include "stereo/fit/lobe.h"

/* The scale that a descent from far begins at. */
#define PST_WIDEST 0.16f

typedef enum pst_descent { PST_DESCENT_FAR, PST_DESCENT_NEAR } pst_descent;

/* Not all the way where it will hardly end below the limit: what is returned costs more then. */
pst_shading pst_lobe_descend(const pst_lobe_data *d, const pst_lobe *lobe, const pst_shading *start, pst_descent from,
                             float limit);

#endif
