/* OBJ files in the words that assimp understands. */
#ifndef MERLIN_SCENE_MESH_OBJ_H
#define MERLIN_SCENE_MESH_OBJ_H

#include <stddef.h>

#include "base/status.h"

/* The text of an OBJ with a zero before numbers that begin with their point (.5) and without a byte order mark: assimp
 * passes over vertices that have either, and faces then mean other ones. Malloc'ed; NULL where there is neither. */
status mesh_tidy_obj(const char *path, char **text, size_t *size);

#endif
