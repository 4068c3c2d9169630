/* SPDX-License-Identifier: MIT */
/* Near lights that were found from pictures alone leave the surface as coarse as the fit that found them. A network of
 * near lights (nfps/) makes a better one under these lights, from which they are found again.
 *
 *     status s = pst_solve_expecting(&capture, &how, &expected, &surface);
 *     if (s == OK) s = near_refine(&(near_refinement){network, &capture, stop}, &surface); */
#ifndef MERLIN_PHOTO_STEREO_NEAR_REFINE_H
#define MERLIN_PHOTO_STEREO_NEAR_REFINE_H

#include "nfps/nfps_network.h"
#include "stereo/integrate/stereo_surface.h"

typedef struct near_refinement {
    const nfps_network *network;
    const merlin_capture *capture; /* with a mask; its lights are unknown */
    int (*stop)(void);             /* may be NULL */
} near_refinement;

/* Changes the surface of a capture of 3 pictures or more that has near lights: its normals to a mean with those that
 * the network finds under them, and from 7 pictures on all of it, of which only the lights are used
 * (pst_expected.lights_alone), to what photometric stereo finds that begins there; where it fails, lights_unsure is
 * set. Others stay as they are. MERLIN_STOPPED, MERLIN_NO_MEMORY. */
status near_refine(const near_refinement *n, merlin_surface *found);

#endif
