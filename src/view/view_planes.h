/* SPDX-License-Identifier: MIT */
/* Maps as planes of 16-bit whole numbers, compressed: what web/scene.js unpacks.
 *
 *     view_planes planes;
 *     status s = view_planes_make(&relighter, &ranges, &planes);
 *     ... planes.at[i].name, data, size ...
 *     view_planes_free(&planes);
 *
 * Steps are finer than what a pixel of a relit picture shows: albedo in 4096 steps of its root; normals' x and y in
 * steps of 1/4096, which is what a half float near 1 resolves; roughness in 4096 steps of its logarithm, for the
 * highlight's height follows its fourth power; depth in 65536 steps of its range. Each number is kept as its difference
 * from left + above - above left, the sign in its lowest bit; all upper bytes stand before all lower ones. */
#ifndef MERLIN_VIEW_VIEW_PLANES_H
#define MERLIN_VIEW_VIEW_PLANES_H

#include <stddef.h>
#include <stdint.h>

#include "estimate/relight/relighter.h"

typedef struct view_range {
    float near, far; /* depths */
} view_range;

/* What depths are told by. */
typedef struct view_ranges {
    view_range covered;  /* of the maps where anything is covered, */
    view_range object;   /* where half or more is, */
    view_range occluder; /* and of what casts shadows, all of it */
} view_ranges;
view_ranges view_ranges_of(const relighter *s);

typedef struct view_plane {
    const char *name;
    uint8_t *data; /* of zlib */
    size_t size;
} view_plane;

enum { VIEW_MOST_PLANES = 10 };
typedef struct view_planes {
    view_plane at[VIEW_MOST_PLANES];
    size_t count;
} view_planes;

/* Of a relighter that casts shadows; one that is matte has no roughness. */
status view_planes_make(const relighter *s, const view_ranges *ranges, view_planes *out);
void view_planes_free(view_planes *planes);

#endif
