/* SPDX-License-Identifier: MIT */
/* The files to which maps are written and from which they are read. */
#ifndef MERLIN_ESTIMATE_FILES_MAPS_FILES_H
#define MERLIN_ESTIMATE_FILES_MAPS_FILES_H

#include "image/exr/exr.h"
#include "merlin/merlin.h"

status maps_write_exr(const merlin_maps *maps, const char *path);
/* Makes the attribute of maps.exr that reveals whether an editor has changed its size. */
exr_attribute maps_picture_size(int width, int height);
/* Reads all maps, at the file's size; roughness and photo are not read and stay zero unless photographed.
 * MERLIN_BAD_INPUT for unusable maps (maps_examine.h); path is for messages. Call merlin_maps_free after a failure,
 * too. */
status maps_read_layers(exr_file *f, const char *path, bool photographed, merlin_maps *maps);
/* Refuses maps of a photograph that maps_read_layers would refuse when they were read again, as they may have been
 * changed in memory. where: for messages. */
status maps_check_values(const char *where, const merlin_maps *maps);
/* Reads a photograph's maps, or those of a captured surface, which become like a photograph's: the square around it is
 * the frame of a camera 60 degrees wide. Call merlin_maps_free after a failure, too. */
status maps_read_photographed(exr_file *f, const char *path, merlin_maps *maps);
status maps_read_captured(exr_file *f, const char *path, merlin_maps *maps);
/* Makes such maps of images in memory: the first sets everything but images, the second takes a captured surface's, of
 * which roughness and photo are zero, to that camera. focal: in pixels; 0: seen from afar, depth in pixels.
 * MERLIN_BAD_INPUT for an object of hardly any pixels, or with depths behind the camera. */
void maps_begin_captured(merlin_maps *maps);
status maps_place_captured(merlin_maps *maps, float focal);
/* Restores the properties that other functions rely on: half floats are not exactly unit normals, and files may have
 * been edited. */
void maps_tidy(merlin_maps *maps);

#endif
