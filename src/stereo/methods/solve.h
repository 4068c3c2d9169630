/* SPDX-License-Identifier: MIT */
/* Normals, albedo and depth from a capture.
 *
 *     pst_surface surface;
 *     status s = pst_solve(&capture, &(pst_options){.method = PST_AUTO}, &surface);
 *     pst_surface_free(&surface); */
#ifndef MERLIN_STEREO_METHODS_SOLVE_H
#define MERLIN_STEREO_METHODS_SOLVE_H

#include "stereo/integrate/surface.h"

typedef struct pst_options {
    pst_method method;
    float shadow;       /* values at or below this share of full scale are left out; 0: chosen */
    float saturation;   /* values at or above; 0: PST_SATURATED */
    int iterations;     /* of iterative methods; 0: chosen */
    const watch *watch; /* MERLIN_STOPPED where it says so; may be NULL */
} pst_options;

status pst_solve(const pst_capture *c, const pst_options *options, pst_surface *out);

#endif
