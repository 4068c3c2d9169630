/* SPDX-License-Identifier: MIT */
/* An examination of maps that were read, whether they can be what merlin estimate and merlin stereo write: anybody may
 * have edited the file, and what cannot be would be clamped without a word.
 *
 *     status s = maps_examine("cup.merlin/maps.exr", targets, count, &maps);
 *     if (s == OK) s = maps_check_crop("cup.merlin/maps.exr", true, &maps);
 */
#ifndef MERLIN_ESTIMATE_FILES_MAPS_EXAMINE_H
#define MERLIN_ESTIMATE_FILES_MAPS_EXAMINE_H

#include "image/exr/exr.h"
#include "merlin/merlin.h"

/* layers: the channels that were read into these maps, by their names in the file.
 *
 * MERLIN_BAD_INPUT, which names path, channel, how many pixels and where the first of them is, for values that are not
 * finite (beside the mask they do not matter), a mask that is no coverage or covers nothing, normals without length,
 * away from the camera or stored as colours, and for maps of which a tenth of the object or more is far out of range:
 * albedo in [0, 255], depth in millimetres. What is less than that can be used: normals become unit, and the shares
 * that were not, or that will be clamped, are noted in maps->mended and doubted. */
status maps_examine(const char *path, const exr_target *layers, size_t count, merlin_maps *maps);

/* MERLIN_BAD_INPUT where the object is not where the crop has it. sized: the file is known to have the size it was
 * written with; then the mask may have become smaller within the crop. */
status maps_check_crop(const char *path, bool sized, const merlin_maps *maps);

#endif
