/* SPDX-License-Identifier: MIT */
/* Maps made ready for many lights, and surroundings. */
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

/* Maps made ready for many lights: the crop at some resolution, and as the network saw it. */
typedef struct relighter {
    surface full, low;
    img low_photo;              /* radiance */
    network_look *look;         /* the network's at it, for the relighting decoder; else NULL */
    img flash;                  /* `low` under it, bounce 1 */
    shadow_occluder occluder;   /* empty unless shadows are cast */
    horizon horizon;            /* the same, and an environment was given */
    const env_map *environment; /* lights beside the point light, or NULL; borrowed */
    float white;                /* the radiance that becomes 1: exposure_white's, unless changed */
    merlin_relighting how;
} relighter;

/* Tells whether lamps and surroundings cast shadows. */
static inline bool relighter_casts_shadows(const relighter *s)
{
    return s->how == MERLIN_BY_BRDF || s->how == MERLIN_BY_BRDF_DIRECT;
}

/* side: the square's pixels a side; 0: as many as the crop has in the photograph. n may be NULL for
 * MERLIN_BY_BRDF_DIRECT. */
status relighter_new(network *n, const merlin_maps *maps, int side, merlin_relighting how, relighter *out);
void relighter_free(relighter *s);
/* Another side for what follows. After a failure the relighter is good for nothing but relighter_free. */
status relighter_resize(relighter *s, const merlin_maps *maps, int side);
/* Takes the gloss away, but for what the relighting decoder paints (docs/notes/rti_domes.md says what for). */
status relighter_make_matte(relighter *s);
/* Measures the white, a radiance, that leaves all but a thousandth of the object's values under these lamps below 1,
 * and a white matte surface that faces one of them at the object's centre. Shadows and bounces are not looked at, so
 * that it takes a fraction of the time of a picture. Without lamps: of the relighter's environment. */
status relighter_meter(const relighter *s, const lamp *lamps, size_t count, float *white);
/* The environment (NULL: none) that lights it from now on; another, or the same turned, may follow. */
status relighter_surround(relighter *s, const env_map *environment);
/* MERLIN_WRONG_USE for a way of relighting that does not exist, or that wants another lamp (NULL: none). */
status relighter_check(merlin_relighting how, const lamp *light, bool environment);
/* Renders the square under so many lamps together and the relighter's environment, one of all at least and as
 * relighter_check wants them, bounces included unless how leaves them out: 3 channels in [0, 1] of `white`. */
status relighter_render(network *n, const relighter *s, const lamp *lights, int count, img *out);

#endif
