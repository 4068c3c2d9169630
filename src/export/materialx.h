/* SPDX-License-Identifier: MIT */
/* A material as MaterialX: standard_surface with the pictures of an export. Source: MaterialX specification 1.38,
 * Autodesk Standard Surface 1.0.1. */
#ifndef MERLIN_EXPORT_MATERIALX_H
#define MERLIN_EXPORT_MATERIALX_H

#include <stdbool.h>

#include "base/status.h"

/* Writes the material of a plane with albedo.png, normal.png and roughness.png next to the file, atomically; matte:
 * without gloss. */
status materialx_write(const char *path, bool matte);

#endif
