/* SPDX-License-Identifier: MIT */
/* The files that maps are written to and read from. */
#ifndef MERLIN_ESTIMATE_FILES_MAPS_FILES_H
#define MERLIN_ESTIMATE_FILES_MAPS_FILES_H

#include "image/exr/exr.h"
#include "merlin/merlin.h"

status maps_write_exr(const merlin_maps *maps, const char *path);
/* Makes the attribute of maps.exr that tells, after an editor has had it, whether it still is of the size it was. */
exr_attribute maps_picture_size(int width, int height);
/* All maps of the file's size and what it holds of them; roughness and photo, unless photographed, are not looked for
 * and stay zero. MERLIN_BAD_INPUT for maps that nothing can be made of (maps_examine.h); path is for messages. After a
 * failure, too, merlin_maps_free. */
status maps_read_layers(exr_file *f, const char *path, bool photographed, merlin_maps *maps);
/* Maps as the inside promises them: half floats are not quite unit normals, and anybody may have edited the file. */
void maps_tidy(merlin_maps *maps);

#endif
