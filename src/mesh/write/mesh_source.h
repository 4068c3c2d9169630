/* SPDX-License-Identifier: MIT */
/* The maps and the camera from which a mesh is made. */
#ifndef MERLIN_MESH_WRITE_MESH_SOURCE_H
#define MERLIN_MESH_WRITE_MESH_SOURCE_H

#include "image/image.h"
#include "optics/camera.h"
#include "optics/pinhole.h"

typedef struct mesh_source {
    const img *depth, *mask;    /* of the same size, as normal */
    const img *normal, *albedo; /* may be NULL; albedo may be of any size where it becomes a texture (OBJ, GLB) */
    const img *roughness;       /* 1 channel, of any size, for GLB; NULL: 1 everywhere */
    pinhole camera;
    camera_slant slant; /* slant of a near camera whose axis is not the lens's (optics/camera.h) */
} mesh_source;

#endif
