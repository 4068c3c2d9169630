/* SPDX-License-Identifier: MIT */
/* The error map of a surface: its name and its scale. */
#ifndef MERLIN_SURFACES_ERROR_MAP_H
#define MERLIN_SURFACES_ERROR_MAP_H

#include "merlin/surface.h"

static inline const char *error_map_name(const merlin_surface *s)
{
    return s->relit.lights ? "spread of the normals" : "residual";
}

/* Returns the value that error.png shows as white. */
static inline float error_map_white(const merlin_surface *s)
{
    return s->relit.lights ? (float)MERLIN_SPREAD_LIMIT : 0.25f;
}

#endif
