/* SPDX-License-Identifier: MIT */
/* The data of a page besides the planes, as JSON: sizes, camera, exposure, and the estimated light. */
#ifndef MERLIN_VIEW_VIEW_SCENE_H
#define MERLIN_VIEW_VIEW_SCENE_H

#include "merlin/view.h"
#include "view/view_planes.h"

/* Returns JSON without "<", so that it can be part of a page; malloc'ed. white: the radiance that becomes 1. */
status view_scene_text(const merlin_maps *maps, const merlin_view_params *params, const relighter *s,
                       const view_ranges *ranges, float white, char **text);

#endif
