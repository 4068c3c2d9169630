/* SPDX-License-Identifier: MIT */
/* A guide finds a surface under near lights in another way, such as by a network: there a search may begin, or it is
 * the result. */
#ifndef MERLIN_STEREO_METHODS_GUIDE_H
#define MERLIN_STEREO_METHODS_GUIDE_H

#include "stereo/capture/capture.h"

typedef struct pst_guide {
    /* Makes normals (3 channels, unit) and depth (1 channel) of the pictures' size; the capture's lights have
     * positions, and its camera a focal length and a distance, which is the depth's mean; NULL: there is no guide. */
    status (*find)(const void *context, const merlin_capture *c, const watch *w, img *normal, img *depth);
    const void *context;
    bool normals_alone; /* pst_expected.normals_alone */
} pst_guide;

#endif
