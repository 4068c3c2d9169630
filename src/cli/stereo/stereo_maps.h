/* SPDX-License-Identifier: MIT */
/* The maps of merlin stereo as merlin estimate's, so that a surface can be relit.
 *
 *     status s = stereo_maps_look("surface", &theirs);
 *     if (s == OK && theirs) s = stereo_maps_read("surface", &maps);
 */
#ifndef MERLIN_CLI_STEREO_STEREO_MAPS_H
#define MERLIN_CLI_STEREO_STEREO_MAPS_H

#include <stdbool.h>

#include "base/status.h"
#include "merlin/merlin.h"

/* Finds whether the folder's maps.exr is one of merlin stereo's; false if it cannot be read. Fails with
 * MERLIN_NO_MEMORY only. */
status stereo_maps_look(const char *folder, bool *theirs);

/* The surface stands where a photograph's would: the crop around it is a frame 60 degrees wide, its mean depth is 1,
 * its relief keeps its proportion to its width. Normals keep their angle to the lines of sight. Nothing was measured of
 * its gloss: it is rough. There is no photograph: `photo` is black. MERLIN_BAD_INPUT for a file that does not hold such
 * maps; free with merlin_maps_free. */
status stereo_maps_read(const char *folder, merlin_maps *out);

#endif
