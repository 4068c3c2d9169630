/* SPDX-License-Identifier: MIT */
/* Maps as PNG for people and other programs, black outside the object.
 *
 *     status s = map_write_normals("normal.png", &normal, &mask);
 *     if (s == OK) s = map_write_depths("depth.png", &depth, &mask);
 */
#ifndef MERLIN_ESTIMATE_FILES_MAP_PNG_H
#define MERLIN_ESTIMATE_FILES_MAP_PNG_H

#include "image/image.h"

/* Writes (n + 1) / 2; normal: 3 channels, mask: 1, above 0 on the object. */
status map_write_normals(const char *path, const img *normal, const img *mask);
/* Writes depths with near ones bright: those of pixels covered by half or more, nearest to farthest, become 1 down to
 * 0.05. depth: 1 channel, of any unit and sign. */
status map_write_depths(const char *path, const img *depth, const img *mask);
/* Writes how sure normals are: a spread (1 channel) of 0 degrees is white, of 30 and more as black as what is outside
 * the object. */
status map_write_confidence(const char *path, const img *spread, const img *mask);

#endif
