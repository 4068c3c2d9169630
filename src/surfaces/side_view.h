/* SPDX-License-Identifier: MIT */
/* A surface seen from the side. */
#ifndef MERLIN_SURFACES_SIDE_VIEW_H
#define MERLIN_SURFACES_SIDE_VIEW_H

#include "image/image.h"
#include "merlin/surface.h"

/* Renders the surface turned by 45 degrees about the vertical axis and lit from the camera: side × side, 1 channel,
 * linear. */
status surface_side_view(const merlin_surface *surface, int side, img *out);

#endif
