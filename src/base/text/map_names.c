/* SPDX-License-Identifier: MIT */
#include "base/text/map_names.h"

#include <stddef.h>

const char *const map_names[] = {"mask.png",  "normal.png",         "albedo.png",   "roughness.png",  "depth.png",
                                 "error.png", "reconstruction.png", "overview.png", "confidence.png", NULL};
