/* SPDX-License-Identifier: MIT */
/* A surface's albedo as files and maps have it. */
#ifndef MERLIN_SURFACES_SURFACE_ALBEDO_H
#define MERLIN_SURFACES_SURFACE_ALBEDO_H

#include "image/image.h"
#include "merlin/surface.h"

/* Copies the albedo as 3 channels in [0, 1], scaled so that its brightest are 0.9. */
status surface_albedo(const merlin_surface *s, img *out);

#endif
