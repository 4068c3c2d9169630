/* SPDX-License-Identifier: MIT */
/* The surface that merlin stereo has found, from the side. */
#ifndef MERLIN_CLI_STEREO_STEREO_VIEW_H
#define MERLIN_CLI_STEREO_STEREO_VIEW_H

#include "cli/stereo/stereo_result.h"

/* The surface turned by 45 degrees about the vertical axis and lit from the camera: side × side, 1 channel, linear. */
status stereo_side_view(const stereo_result *r, int side, img *out);

#endif
