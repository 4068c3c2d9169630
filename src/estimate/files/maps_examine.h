/* SPDX-License-Identifier: MIT */
/* Checks whether maps that were read can be what merlin estimate and merlin stereo write, as files may have been edited
 * and impossible values would be clamped silently.
 *
 *     status s = maps_examine("cup.merlin/maps.exr", targets, count, &maps);
 *     if (s == OK) s = maps_check_crop("cup.merlin/maps.exr", true, &maps);
 */
#ifndef MERLIN_ESTIMATE_FILES_MAPS_EXAMINE_H
#define MERLIN_ESTIMATE_FILES_MAPS_EXAMINE_H

#include "image/exr/exr.h"
#include "merlin/merlin.h"

/* Examines maps. layers: the channels that were read into them, by their names in the file.
 *
 * MERLIN_BAD_INPUT, with path, channel, number of pixels and the place of the first, for values that are not finite
 * (except outside the mask), a mask that is no coverage or covers nothing, normals without length, facing away from the
 * camera or stored as colours, and for maps in which a tenth of the object or more is far out of range, such as albedo
 * in [0, 255] or depth in millimetres. Smaller errors are tolerated: normals become unit, and the shares of pixels that
 * were not unit or will be clamped are recorded in maps->mended and doubted. */
status maps_examine(const char *path, const exr_target *layers, size_t count, merlin_maps *maps);

/* Does the same with maps that are to be written, and changes nothing. */
status maps_look_through(const char *where, const exr_target *layers, size_t count, const merlin_maps *maps);

/* Fails with MERLIN_BAD_INPUT if the object is not where the crop has it. sized: the file is known to have the size
 * with which it was written; then the mask may have become smaller within the crop. */
status maps_check_crop(const char *path, bool sized, const merlin_maps *maps);

#endif
