/* SPDX-License-Identifier: MIT */
/* Names of the pictures of maps, by which what merlin wrote is known again: as no photograph, and as what would be
 * replaced. */
#ifndef MERLIN_BASE_TEXT_MAP_NAMES_H
#define MERLIN_BASE_TEXT_MAP_NAMES_H

/* Names of all PNGs that estimate and stereo write beside maps.exr, except meshes' textures; ended by NULL. */
extern const char *const map_names[];

#endif
