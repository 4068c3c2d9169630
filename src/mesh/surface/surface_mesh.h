/* SPDX-License-Identifier: MIT */
/* A depth map as triangles: the maker of the public mesh. */
#ifndef MERLIN_MESH_SURFACE_SURFACE_MESH_H
#define MERLIN_MESH_SURFACE_SURFACE_MESH_H

#include "merlin/mesh.h"
#include "mesh/surface/mesh_source.h"

/* Makes a vertex for each pixel inside the mask; triangles across a depth discontinuity are left out. Positions are in
 * camera space: in depth's unit, or in pixels without perspective. MERLIN_WRONG_USE for maps of different sizes,
 * MERLIN_BAD_INPUT for an empty mask; free with merlin_mesh_free. */
status surface_mesh_new(const mesh_source *from, merlin_mesh *out);

#endif
