/* SPDX-License-Identifier: MIT */
/* Maps prepared for many lights and environments. */
#ifndef MERLIN_ESTIMATE_RELIGHT_RELIGHTER_H
#define MERLIN_ESTIMATE_RELIGHT_RELIGHTER_H

#include "estimate/light/env_map.h"
#include "estimate/light/horizon.h"
#include "estimate/light/shadow.h"
#include "estimate/photo/network.h"
#include "estimate/surface/surface.h"
#include "merlin/merlin.h"

struct merlin_environment {
    env_map map;
    double negative; /* share of the file's values that were negative */
};

/* Maps prepared for many lights: the crop at some resolution, and at the network's. */
typedef struct relighter {
    surface full, low;
    img low_photo;              /* radiance of the photograph at the network's size */
    network_features *features; /* features for the relighting decoder; else NULL */
    img flash;                  /* bounce 1 of `low` under the flash */
    shadow_occluder occluder;   /* empty unless shadows are cast */
    horizon horizon;            /* set only if shadows are cast and there is an environment */
    const env_map *environment; /* environment in addition to the lamps, or NULL; borrowed */
    float white;                /* radiance that becomes 1: by exposure_white, unless changed */
    merlin_relighting how;
} relighter;

/* Tells whether lamps and environment cast shadows. */
static inline bool relighter_casts_shadows(const relighter *s)
{
    return s->how == MERLIN_BY_BRDF || s->how == MERLIN_BY_BRDF_DIRECT;
}

/* Prepares maps. side: the square's pixels per side; 0: as many as the crop has in the photograph. n may be NULL for
 * MERLIN_BY_BRDF_DIRECT. Captured surfaces are matte. */
status relighter_new(network *n, const merlin_maps *maps, int side, merlin_relighting how, relighter *out);
void relighter_free(relighter *s);
/* Changes the side. After a failure the relighter may only be freed. */
status relighter_resize(relighter *s, const merlin_maps *maps, int side);
/* Removes gloss, except for what the relighting decoder paints (docs/notes/rti_domes.md gives the reason). */
status relighter_make_matte(relighter *s);
/* Measures a white, a radiance below which are all but a thousandth of the object's values under these lamps, and a
 * white matte surface that faces one of them at the object's centre. It ignores shadows and bounces, and so takes a
 * fraction of the time of a picture. Without lamps the relighter's environment is used. */
status relighter_meter(const relighter *s, const lamp *lamps, size_t count, float *white);
/* Sets the environment (NULL: none) for the following pictures; another, or the same one turned, may follow. */
status relighter_surround(relighter *s, const env_map *environment);
/* Fails with MERLIN_WRONG_USE for a method of relighting that does not exist, or that needs another lamp (NULL: none).
 */
status relighter_check(merlin_relighting how, const lamp *light, bool environment);
/* Renders the square under all lamps together and the relighter's environment; at least one of them is needed, as
 * relighter_check requires. Bounces are included unless `how` excludes them. out: 3 channels in [0, 1] of `white`. */
status relighter_render(network *n, const relighter *s, const lamp *lights, int count, img *out);

#endif
