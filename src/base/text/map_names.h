/* SPDX-License-Identifier: MIT */
/* Names of the pictures of maps, by which what merlin wrote is known again: as no photograph, and as what would be
 * replaced. */
#ifndef MERLIN_BASE_TEXT_MAP_NAMES_H
#define MERLIN_BASE_TEXT_MAP_NAMES_H

#include <stdbool.h>

#include "base/status.h"

/* Names of all PNGs that estimate and stereo write beside maps.exr, except meshes' textures; ended by NULL. */
extern const char *const map_names[];

/* Tells whether a folder is not there, or has an earlier result, a maps.exr or report.json, which may be replaced. */
bool map_names_is_free(const char *folder);
/* Refuses a folder that has a file of these names, but no maps.exr or report.json: it is somebody's picture, not an
 * earlier result, and would be replaced. MERLIN_CANNOT_WRITE. */
status map_names_check(const char *folder);
/* The same words for another file, and another one that would be beside it. */
status map_names_refuse(const char *folder, const char *name, const char *beside);
/* Tells whether a folder has a plain file of this name. */
bool map_names_is_in(const char *folder, const char *name);

#endif
