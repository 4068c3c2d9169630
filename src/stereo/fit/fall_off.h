/* SPDX-License-Identifier: MIT */
/* How far away a pixel is, from how its light falls off.
 *
 *     pst_fall_off found = pst_fall_off_of(&here, &deeper, &lobe, &shading);
 *
 * Near lights say so themselves: only at the right distance do inverse squares, directions and one surface agree. A
 * pixel says it with much noise, and normals say nothing else as well, so this is for what normals cannot tell: how far
 * behind another part of the object a part lies. */
#ifndef MERLIN_STEREO_FIT_FALL_OFF_H
#define MERLIN_STEREO_FIT_FALL_OFF_H

#include "stereo/fit/lobe_fit.h"

/* How much deeper `deeper` is: log depth. */
#define PST_DEEPER 0.01f

typedef struct pst_fall_off {
    float offset; /* what log depth is off by, as far as this pixel knows */
    float trust;  /* one over the offset's variance; 0: knows nothing */
} pst_fall_off;

/* here, deeper: the same pixel's observations where its depth was thought to be, and PST_DEEPER behind it; shading: the
 * fit to `here`. One Gauss-Newton step in depth, with normal, albedo and lobe free to follow. */
pst_fall_off pst_fall_off_of(const pst_lobe_data *here, const pst_lobe_data *deeper, const pst_lobe *lobe,
                             const pst_shading *at);

#endif
