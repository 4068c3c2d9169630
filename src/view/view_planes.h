/* SPDX-License-Identifier: MIT */
/* Maps as planes of 16-bit integers, compressed, which web/scene.js decodes.
 *
 *     view_planes planes;
 *     status s = view_planes_make(&relighter, &ranges, &planes);
 *     ... planes.at[i].name, data, size ...
 *     view_planes_free(&planes);
 *
 * Steps are finer than what a pixel of a relit picture shows: albedo in 4096 steps of its square root; normals' x and y
 * in steps of 1/4096, the resolution of a half float near 1; roughness in 4096 steps of its logarithm, as the
 * highlight's height depends on its fourth power; depth in 65536 steps of its range. Each number is stored as its
 * difference from left + above - above left, with the sign in its lowest bit; all upper bytes precede all lower ones.
 */
#ifndef MERLIN_VIEW_VIEW_PLANES_H
#define MERLIN_VIEW_VIEW_PLANES_H

#include <stddef.h>
#include <stdint.h>

#include "estimate/relight/relighter.h"

typedef struct view_range {
    float near, far; /* range of depths */
} view_range;

/* Ranges of depth for the encoding. */
typedef struct view_ranges {
    view_range covered;  /* of the maps' covered pixels */
    view_range object;   /* of pixels with a coverage of half or more */
    view_range occluder; /* of all of the occluder */
} view_ranges;
view_ranges view_ranges_of(const relighter *s);

typedef struct view_plane {
    const char *name;
    uint8_t *data; /* zlib data */
    size_t size;
} view_plane;

enum { VIEW_MOST_PLANES = 10 };
typedef struct view_planes {
    view_plane at[VIEW_MOST_PLANES];
    size_t count;
} view_planes;

/* Makes the planes of a relighter that casts shadows; a matte one has no roughness. */
status view_planes_make(const relighter *s, const view_ranges *ranges, view_planes *out);
void view_planes_free(view_planes *planes);

#endif
