/* SPDX-License-Identifier: MIT */
/* The maps and the camera from which a mesh is made. */
#ifndef MERLIN_MESH_SURFACE_MESH_SOURCE_H
#define MERLIN_MESH_SURFACE_MESH_SOURCE_H

#include "image/image.h"
#include "optics/camera.h"
#include "optics/pinhole.h"

typedef struct mesh_source {
    const img *depth, *mask;    /* of the same size, as normal and albedo, 1 or 3 channels, linear in [0, 1]; */
    const img *normal, *albedo; /* these may be NULL */
    const img *texture;         /* albedo of any size; NULL: albedo */
    const img *roughness;       /* 1 channel, of any size; NULL: 1 everywhere */
    pinhole camera;
    camera_slant slant; /* slant of a near camera whose axis is not the lens's (optics/camera.h) */
} mesh_source;

#endif
