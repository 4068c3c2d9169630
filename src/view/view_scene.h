/* SPDX-License-Identifier: MIT */
/* What a page says of its maps beside the planes, as JSON: sizes, camera, exposure, and the light that was found. */
#ifndef MERLIN_VIEW_VIEW_SCENE_H
#define MERLIN_VIEW_VIEW_SCENE_H

#include "merlin/view.h"
#include "view/view_planes.h"

/* JSON in which no "<" stands, so that it may stand in a page; malloc'ed. white: the radiance that becomes 1. */
status view_scene_text(const merlin_maps *maps, const merlin_view_params *params, const relighter *s,
                       const view_ranges *ranges, float white, char **text);

#endif
