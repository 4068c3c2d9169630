/* SPDX-License-Identifier: MIT */
/* The files of which a mesh consists, by its name's ending: of owl.obj they are owl.obj, owl.mtl and owl.png. */
#ifndef MERLIN_BASE_TEXT_MESH_PARTS_H
#define MERLIN_BASE_TEXT_MESH_PARTS_H

#include "base/status.h"

typedef enum mesh_part { MESH_SCENE, MESH_MATERIAL, MESH_ALBEDO, MESH_NORMAL, MESH_ROUGHNESS, MESH_PARTS } mesh_part;

/* Returns what a part's name has in the place of the mesh's ending; for MESH_SCENE, the mesh's own file, that ending in
 * lower case, or NULL if meshes are not written under this name. NULL if they have no such part. */
const char *mesh_part_ending(const char *mesh, mesh_part part);
/* Composes the path of a part that exists, which is path itself for MESH_SCENE; malloc'ed, or NULL without memory. */
char *mesh_part_path(const char *path, mesh_part part);
/* Refuses to replace a file beside a mesh, one of its parts, that belongs to something else: neither the mesh is there,
 * nor another one of its name with this part, as owl.obj and owl.usda share owl.png. */
status mesh_part_check(const char *mesh, const char *file);

#endif
