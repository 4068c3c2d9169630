/* SPDX-License-Identifier: MIT */
/* Integrates normals to a surface over the mask.
 *
 *     img depth;
 *     status s = pst_integrate(&normal, &mask, &camera, &(pst_integration){.preserve_edges = true}, &depth);
 */
#ifndef MERLIN_STEREO_INTEGRATE_INTEGRATE_H
#define MERLIN_STEREO_INTEGRATE_INTEGRATE_H

#include "stereo/capture/capture.h"

/* Weight of a prior that determines depth where normals do not, and changes nothing elsewhere. */
#define PST_KEEP_DEPTH 1e-4f

typedef struct pst_integration {
    bool preserve_edges; /* discontinuity-preserving method instead of least squares: keeps steps that the normals
                          * reveal, but may also cut where the normals have errors */
    const img *prior;    /* depth toward which the result is weakly pulled, 1 channel, or NULL */
    float prior_weight;
    const img *trust;   /* factor of the prior's weight for each pixel, 1 channel; NULL: 1 everywhere */
    bool from_prior;    /* whether preserve_edges starts from the prior's steps instead of from least squares, which
                         * spreads them: a few solutions instead of fifty. Requires a prior at every pixel of the mask */
    const watch *watch; /* receives progress, "integrating", and may stop the work (MERLIN_STOPPED); may be NULL */
} pst_integration;

/* Computes depth: 1 channel, distance along -z, zero outside the mask. Orthographic: in pixels, of mean 0, shifted to
 * be positive; perspective: log-depth is integrated and scaled to the camera's distance (1 if unknown). Each connected
 * piece of the mask has its own constant. */
status pst_integrate(const img *normal, const img *mask, const pinhole *camera, const pst_integration *options,
                     img *depth);

#endif
