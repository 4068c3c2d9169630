/* SPDX-License-Identifier: MIT */
/* Limits of a mesh and its files. */
#ifndef MERLIN_MESH_READ_MESH_LIMITS_H
#define MERLIN_MESH_READ_MESH_LIMITS_H

#include <stddef.h>

/* Largest number of triangles of a mesh; largest size of a file, or of all files of one mesh, bytes. */
enum { MESH_TRIANGLES = 5000000, MESH_BYTES = 1 << 30 };

/* Returns how many triangles a mesh of so many bytes may have: five million, and fewer for a small file, which can only
 * repeat itself: one plus as many as it has bytes for. */
size_t mesh_most_triangles(size_t bytes);

#endif
