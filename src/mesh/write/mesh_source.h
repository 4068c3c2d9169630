/* SPDX-License-Identifier: MIT */
/* The maps and the camera that a mesh is made of. */
#ifndef MERLIN_MESH_WRITE_MESH_SOURCE_H
#define MERLIN_MESH_WRITE_MESH_SOURCE_H

#include "image/image.h"
#include "optics/camera.h"
#include "optics/pinhole.h"

typedef struct mesh_source {
    const img *depth, *mask;    /* of one size, as normal */
    const img *normal, *albedo; /* may be NULL; albedo, where it becomes a texture (OBJ, GLB), of any size */
    const img *roughness;       /* 1 channel, of any size, for GLB; NULL: 1 everywhere */
    pinhole camera;
    camera_slant slant; /* of a near camera whose axis is not the lens's (optics/camera.h) */
} mesh_source;

#endif
