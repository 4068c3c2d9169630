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

/* Surroundings: a latitude-longitude picture, twice as wide as high (Radiance HDR or EXR; up is its top row, straight
 * ahead of the camera its middle column, right of that the camera's right). */
typedef struct merlin_environment merlin_environment;

/* Such files are in no known unit: mean luminance becomes 2^exposure, at 0 a white object about as bright as
 * under the flash. turn: degrees about the vertical; at 90 what was straight ahead is to the camera's right. */
merlin_status merlin_environment_read(const char *path, float turn, float exposure, merlin_environment **out);
void merlin_environment_free(merlin_environment *environment);

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
void merlin_relighter_free(merlin_relighter *relighter);

#ifdef __cplusplus
}
#endif

#endif
