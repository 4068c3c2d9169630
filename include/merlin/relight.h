/* SPDX-License-Identifier: MIT */
/* merlin/relight: maps under other light.
 *
 *     merlin_relighter *relighter;
 *     merlin_image picture;
 *     if (merlin_relighter_new(model, &maps, 256, MERLIN_BY_BRDF, &relighter) ||
 *         merlin_relighter_render(relighter, light, NULL, &picture))
 *         fprintf(stderr, "%s\n", merlin_error());
 *
 * merlin_relight and similar functions make a single picture; for many pictures of the same maps use a relighter. */
#ifndef MERLIN_RELIGHT_H
#define MERLIN_RELIGHT_H

#include <merlin/lights.h>
#include <merlin/maps.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum merlin_relighting {
    MERLIN_BY_BRDF,    /* the maps' microfacet BRDF with cast shadows, plus the network's global illumination */
    MERLIN_BY_NETWORK, /* the relighting decoder, for lights on the frontal hemisphere: (sinθ cosφ, sinθ sinφ,
                        * cosθ - 1), or 0.5 to 2 away from (0, 0, -1) instead of 1, with an environment 0.8 to 1.25 */
    MERLIN_BY_BRDF_UNSHADOWED, /* by the BRDF without cast shadows, as in the paper */
    MERLIN_BY_BRDF_DIRECT,     /* by the BRDF with cast shadows, without the network's global illumination */
} merlin_relighting;

/* Renders the object under one point light at this position instead of the flash, with the flash's power (5.95). The
 * picture has the photograph's size and exposure (the default one if its values exceed 1), and 3 channels in [0, 1]. */
merlin_status merlin_relight(merlin_model *model, const merlin_maps *maps, const float light[3], merlin_relighting how,
                             merlin_image *out);

/* Renders the object in this environment, and under a point light unless that is NULL: the diffuse part by nine
 * spherical harmonics, highlights from the picture itself. MERLIN_BY_BRDF: with shadows and a bounce. MERLIN_BY_NETWORK
 * needs a light and a model trained for both; the environment casts no shadows then. */
merlin_status merlin_relight_environment(merlin_model *model, const merlin_maps *maps,
                                         const merlin_environment *environment, const float *light,
                                         merlin_relighting how, merlin_image *out);

/* Relights by the light that was estimated from the photograph (maps.light), with lamp and environment turned about the
 * vertical in degrees: 90 moves what was straight ahead of the camera to its right; a flash stays at the lens.
 * MERLIN_BAD_INPUT if the model estimated none; not for MERLIN_BY_NETWORK. */
merlin_status merlin_relight_found(merlin_model *model, const merlin_maps *maps, float turn, merlin_relighting how,
                                   merlin_image *out);

/* Maps prepared once for many lights, each of which then takes a fraction of the time. */
typedef struct merlin_relighter merlin_relighter;

/* Prepares maps. side: pixels a side of the pictures, which show the square `crop`; 0: as many as it has in the
 * photograph; at most 8000. The maps may be freed afterwards; the model must outlive the relighter. */
merlin_status merlin_relighter_new(merlin_model *model, const merlin_maps *maps, int side, merlin_relighting how,
                                   merlin_relighter **out);
/* Renders the square under a point light (or NULL), in an environment (or NULL), or both: side x side, 3 channels in
 * [0, 1], zero outside the object. A relighter may be used by one thread at a time. */
merlin_status merlin_relighter_render(merlin_relighter *relighter, const float *light,
                                      const merlin_environment *environment, merlin_image *out);
/* Renders the same under these lamps together, and in an environment (or NULL); at least one of them is needed. */
merlin_status merlin_relighter_render_lamps(merlin_relighter *relighter, const merlin_lamp *lamps, int count,
                                            const merlin_environment *environment, merlin_image *out);
void merlin_relighter_free(merlin_relighter *relighter);

/* Returns MERLIN_WRONG_USE if a way of relighting does not exist, or does not support such a lamp (NULL: none), alone
 * or in an environment, so that one can check before long work. */
merlin_status merlin_relighting_check(merlin_relighting how, const merlin_lamp *lamp, int surroundings);
/* Returns the name of the weights that estimate the bounces of these maps under lamps, or whose decoder relights them:
 * of a model with a second one for flashes it may be either's. Valid while the model is open; "" for NULL. */
const char *merlin_relighting_model(const merlin_model *model, const merlin_maps *maps, merlin_relighting how);
/* Adds other_model to a list of warnings if these weights are not those that made the maps. */
void merlin_relighting_warnings(const merlin_model *model, const merlin_maps *maps, merlin_relighting how,
                                merlin_warnings *list);

/* ---- a relighter's pictures ---- */

/* Removes gloss from all further pictures, except for what MERLIN_BY_NETWORK paints. */
merlin_status merlin_relighter_make_matte(merlin_relighter *relighter);
/* Changes the side of further pictures, which show the maps from which it was made. After a failure the relighter may
 * only be freed. */
merlin_status merlin_relighter_resize(merlin_relighter *relighter, const merlin_maps *maps, int side);
/* Returns the object in the pictures: 1 channel, coverage in [0, 1], valid while the relighter has this side. */
const merlin_image *merlin_relighter_mask(const merlin_relighter *relighter);
/* Places a picture in the photograph's frame, black outside the object. MERLIN_WRONG_USE unless the square has as many
 * pixels as in the photograph. */
merlin_status merlin_relighter_place(const merlin_relighter *relighter, const merlin_image *square, merlin_image *out);

/* Return and set the radiance that is white in the pictures, by default that of the photograph's exposure. */
float merlin_relighter_white(const merlin_relighter *relighter);
merlin_status merlin_relighter_set_white(merlin_relighter *relighter, float white);
/* Measures a white that all but a thousandth of the object's values are below under each of these lamps, as is a white
 * matte surface that faces one of them at the object's centre, in this environment (or NULL), or in that alone without
 * lamps. It ignores shadows and bounces, and so takes a fraction of the time of a picture. */
merlin_status merlin_relighter_meter(merlin_relighter *relighter, const merlin_lamp *lamps, size_t count,
                                     const merlin_environment *environment, float *white);
/* Does the same for one picture by all of them, as the sum of what each needs. */
merlin_status merlin_relighter_meter_together(merlin_relighter *relighter, const merlin_lamp *lamps, size_t count,
                                              const merlin_environment *environment, float *white);

#ifdef __cplusplus
}
#endif

#endif
