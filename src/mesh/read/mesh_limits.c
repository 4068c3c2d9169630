/* SPDX-License-Identifier: MIT */
#include "mesh/read/mesh_limits.h"

enum { SMALL_FILE_TRIANGLES = 1000000, TRIANGLE_BYTES = 4 };

size_t mesh_most_triangles(size_t bytes)
{
    size_t most = SMALL_FILE_TRIANGLES + bytes / TRIANGLE_BYTES;
    return most < MESH_TRIANGLES ? most : MESH_TRIANGLES;
}
