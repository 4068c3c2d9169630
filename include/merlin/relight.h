/* SPDX-License-Identifier: MIT */
/* merlin/relight: maps under other light.
 *
 *     merlin_relighter *relighter;
 *     merlin_image picture;
 *     if (merlin_relighter_new(model, &maps, 256, MERLIN_BY_BRDF, &relighter) ||
 *         merlin_relighter_render(relighter, light, NULL, &picture))
 *         fprintf(stderr, "%s\n", merlin_error());
 *
 * A single picture is made by merlin_relight and the like; many of the same maps, by a relighter. */
#ifndef MERLIN_RELIGHT_H
#define MERLIN_RELIGHT_H

#include <merlin/lights.h>
#include <merlin/maps.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum merlin_relighting {
    MERLIN_BY_BRDF, /* the maps' microfacet BRDF with cast shadows, plus the network's global illumination */
    MERLIN_BY_NETWORK, /* the relighting decoder, for lights on the frontal hemisphere: (sinθ cosφ, sinθ sinφ, cosθ - 1)
                        */
    MERLIN_BY_BRDF_UNSHADOWED, /* by the BRDF without cast shadows, as in the paper */
    MERLIN_BY_BRDF_DIRECT,     /* by the BRDF with cast shadows, without the network's global illumination */
} merlin_relighting;

/* The object under one point light at this place instead of the flash, of the flash's power (5.95): the photograph's
 * size and exposure (the usual one if its values go beyond 1), 3 channels in [0, 1]. */
merlin_status merlin_relight(merlin_model *model, const merlin_maps *maps, const float light[3], merlin_relighting how,
                             merlin_image *out);

/* The object in these surroundings, and under a point light too unless that is NULL: diffuse by nine spherical
 * harmonics, highlights from the picture itself. MERLIN_BY_BRDF: with the shadows that the object casts on itself and a
 * bounce. MERLIN_BY_NETWORK needs a light and a model that was trained for both; its surroundings cast no shadows. */
merlin_status merlin_relight_environment(merlin_model *model, const merlin_maps *maps,
                                         const merlin_environment *environment, const float *light,
                                         merlin_relighting how, merlin_image *out);

/* Relights by the light that was found in the photograph (maps.light), its lamp and surroundings turned about the
 * vertical by so many degrees: at 90 what was straight ahead of the camera is to its right; a flash stays at the lens.
 * MERLIN_BAD_INPUT where the model found none; not MERLIN_BY_NETWORK. */
merlin_status merlin_relight_found(merlin_model *model, const merlin_maps *maps, float turn, merlin_relighting how,
                                   merlin_image *out);

/* Maps made ready once for many lights, which each take a fraction of the time then. */
typedef struct merlin_relighter merlin_relighter;

/* side: pixels a side of the pictures, which show the square `crop`; 0: as many as it has in the photograph; at most
 * 8000. The maps may be freed afterwards; the model must outlive the relighter. */
merlin_status merlin_relighter_new(merlin_model *model, const merlin_maps *maps, int side, merlin_relighting how,
                                   merlin_relighter **out);
/* The square under a point light (or NULL), in surroundings (or NULL), or both: side x side, 3 channels in [0, 1], zero
 * beside the object. One thread at a time for a relighter. */
merlin_status merlin_relighter_render(merlin_relighter *relighter, const float *light,
                                      const merlin_environment *environment, merlin_image *out);
/* Renders the same under so many lamps together, and in surroundings (or NULL): one of all at least. */
merlin_status merlin_relighter_render_lamps(merlin_relighter *relighter, const merlin_lamp *lamps, int count,
                                            const merlin_environment *environment, merlin_image *out);
void merlin_relighter_free(merlin_relighter *relighter);

/* Returns MERLIN_WRONG_USE where a way of relighting does not exist, or knows no such lamp (NULL: none), alone or in
 * surroundings: asked before long work. */
merlin_status merlin_relighting_check(merlin_relighting how, const merlin_lamp *lamp, int surroundings);

/* ---- a relighter's pictures ---- */

/* Takes the gloss away from all that follow, but for what MERLIN_BY_NETWORK paints. */
merlin_status merlin_relighter_make_matte(merlin_relighter *relighter);
/* Gives those that follow another side, of the maps it was made of. After a failure it is good for nothing but
 * merlin_relighter_free. */
merlin_status merlin_relighter_resize(merlin_relighter *relighter, const merlin_maps *maps, int side);
/* Returns the object in them: 1 channel, coverage in [0, 1], as long as the relighter has this side. */
const merlin_image *merlin_relighter_mask(const merlin_relighter *relighter);
/* Puts a picture into the photograph's frame, black beside the object. MERLIN_WRONG_USE unless the square has as many
 * pixels as in the photograph. */
merlin_status merlin_relighter_place(const merlin_relighter *relighter, const merlin_image *square, merlin_image *out);

/* Return and set the radiance that is white in them, at first as the photograph was exposed. */
float merlin_relighter_white(const merlin_relighter *relighter);
merlin_status merlin_relighter_set_white(merlin_relighter *relighter, float white);
/* Measures the white that leaves all but a thousandth of the object's values below it under each of these lamps, and a
 * white matte surface that faces one of them at the object's centre; without lamps, in these surroundings (or NULL).
 * Shadows and bounces are not looked at, so that it takes a fraction of the time of a picture. */
merlin_status merlin_relighter_meter(merlin_relighter *relighter, const merlin_lamp *lamps, size_t count,
                                     const merlin_environment *environment, float *white);

#ifdef __cplusplus
}
#endif

#endif
