/* SPDX-License-Identifier: MIT */
/* The distance of a pixel, from the fall-off of its light.
 *
 *     pst_fall_off found = pst_fall_off_of(&here, &deeper, &lobe, &shading);
 *
 * Near lights determine it: only at the correct distance are inverse squares and directions consistent with one
 * surface. A single pixel's estimate is noisy, and normals are more accurate for everything else, so that this serves
 * for what normals cannot determine: how far behind another part of the object a part lies. */
#ifndef MERLIN_STEREO_FIT_FALL_OFF_H
#define MERLIN_STEREO_FIT_FALL_OFF_H

#include "stereo/fit/lobe_fit.h"

/* Step in log depth to `deeper`. */
#define PST_DEEPER 0.01f

typedef struct pst_fall_off {
    float offset; /* correction of log depth by this pixel */
    float trust;  /* inverse variance of the offset; 0: unknown */
} pst_fall_off;

/* Makes one Gauss-Newton step in depth, with normal, albedo and lobe free. here, deeper: the pixel's observations for
 * its present depth, and for PST_DEEPER behind it; shading: the fit to `here`. */
pst_fall_off pst_fall_off_of(const pst_lobe_data *here, const pst_lobe_data *deeper, const pst_lobe *lobe,
                             const pst_shading *at);

#endif
