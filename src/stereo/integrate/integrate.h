/* SPDX-License-Identifier: MIT */
/* From normals to a surface over the mask.
 *
 *     img depth;
 *     status s = pst_integrate(&normal, &mask, &camera, &(pst_integration){.preserve_edges = true}, &depth); */
#ifndef MERLIN_STEREO_INTEGRATE_INTEGRATE_H
#define MERLIN_STEREO_INTEGRATE_INTEGRATE_H

#include "stereo/capture/capture.h"

/* A prior's weight that holds depth where normals leave it free, and nowhere bends it. */
#define PST_KEEP_DEPTH 1e-4f

typedef struct pst_integration {
    bool preserve_edges; /* discontinuity-preserving variant instead of least squares: keeps steps that the normals
                          * betray, but may also cut where the normals have errors of their own */
    const img *prior;    /* 1 channel depth pulled toward weakly, or NULL */
    float prior_weight;
    const img *trust; /* 1 channel, a pixel's factor on the prior's weight; NULL: 1 everywhere */
    bool from_prior;  /* preserve_edges starts from the prior's steps instead of from least squares, which spreads them:
                       * a few solutions instead of fifty. Needs a prior at every pixel of the mask */
    const watch *watch; /* told of the solutions, "integrating"; MERLIN_STOPPED where it says so; may be NULL */
} pst_integration;

/* depth: 1 channel, distance along -z, zero outside the mask. Orthographic: in pixels, mean 0 shifted to be positive;
 * perspective: log-depth is integrated, scaled to the camera's distance (1 if unknown). Each connected piece of
 * the mask has its own constant. */
status pst_integrate(const img *normal, const img *mask, const pinhole *camera, const pst_integration *options,
                     img *depth);

#endif
