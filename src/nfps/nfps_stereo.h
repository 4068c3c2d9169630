/* SPDX-License-Identifier: MIT */
/* Photometric stereo under known near lights by a network (model/nfps.h): normals at a coarse scale, and at each
 * finer one better ones from them and from the depth that they integrate to.
 *
 *     nfps_network *n;
 *     status s = nfps_network_open("merlin-nfps.safetensors", &n);
 *     if (s == OK) s = nfps_stereo(n, &capture, &(nfps_options){0}, &normal, &depth);
 */
#ifndef MERLIN_NFPS_NFPS_STEREO_H
#define MERLIN_NFPS_NFPS_STEREO_H

#include "nfps/nfps_network.h"
#include "stereo/capture/capture.h"
#include "stereo/methods/guide.h"

typedef struct nfps_options {
    int largest;        /* side up to which pictures are seen; 0: 512 */
    bool estimated;     /* the lights are estimates, off by several degrees */
    const watch *watch; /* may be NULL */
} nfps_options;

/* Makes normals (3 channels, unit) and depth (1 channel) of the pictures' size, zero outside the mask, from a capture's
 * lights, of which at most NN_LARGEST_GROUP are used, evenly chosen. Depth is in the unit of the camera's distance; if
 * that is unknown it is taken to be the lights'. MERLIN_WRONG_USE for unknown lights and a camera far away,
 * MERLIN_BAD_INPUT for fewer than 2 pictures, MERLIN_STOPPED, MERLIN_NO_MEMORY. */
status nfps_stereo(const nfps_network *n, const merlin_capture *c, const nfps_options *options, img *normal,
                   img *depth);

/* Returns the guide who tells what this network finds, for pst_stereo_guided; n is borrowed, NULL: nobody. */
pst_guide nfps_guide(const nfps_network *n);

#endif
