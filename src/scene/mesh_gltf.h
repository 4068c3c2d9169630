/* What assimp passes over in a glTF file (glTF 2.0, ISO/IEC 12113). */
#ifndef MERLIN_SCENE_MESH_GLTF_H
#define MERLIN_SCENE_MESH_GLTF_H

#include "base/status.h"

/* ERROR_INPUT for a .gltf or .glb that requires an extension by which its positions mean something else than they say.
 * OK for what is damaged: that is assimp's to say. */
status mesh_check_gltf(const char *path);

#endif
