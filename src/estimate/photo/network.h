/* SPDX-License-Identifier: MIT */
/* The trained networks of one weights file, compiled when first needed and kept for further photographs.
 *
 *     network *n;
 *     status s = network_open("merlin-point.safetensors", &n);
 *     s = network_estimate(n, &photo, &mask, &how, NETWORK_VIEWS, NULL, &estimation);
 *     network_close(n);
 *
 * Images are square, with sides that are a multiple of 32 pixels, and linear. Calls from several threads are run one at
 * a time. */
#ifndef MERLIN_ESTIMATE_PHOTO_NETWORK_H
#define MERLIN_ESTIMATE_PHOTO_NETWORK_H

#include "estimate/surface/estimation.h"
#include "estimate/surface/sight.h"
#include "optics/light.h"

/* Sizes of the network's pictures in pixels. The shipped weights were last trained at NETWORK_SIZE; in slightly larger
 * pictures they estimate fine shape well, and coarse shape badly (detail.h). */
enum { NETWORK_LEAST_SIZE = 64, NETWORK_SIZE = 256, NETWORK_LARGEST_SIZE = 512 };

/* Size at which several photographs are compared, that of the training for it: light is coarse. */
enum { NETWORK_SEVERAL_SIZE = 96 };

/* Default number of orientations in which a photograph is estimated: compared with one, four take 55 ms more than an
 * estimate's 145, and have five to ten per cent less error (docs/notes/several_views.md). */
enum { NETWORK_VIEWS = 4 };

/* Returns the side of the picture for all but fine shape when `size` is requested. */
static inline int network_side(int size)
{
    return size < NETWORK_SIZE ? size : NETWORK_SIZE;
}

typedef struct network network;

/* Opens a weights file; MERLIN_BAD_INPUT if it is not one of merlin, or only tells lights. The network computes in
 * nn_fastest_type. */
status network_open(const char *weights, network **out);
/* Opens a weights file but reads only its configuration; the parameters, most of the file, are read when a program is
 * first compiled. */
status network_open_later(const char *weights, network **out);
/* Does the same for network_lights_several. MERLIN_WRONG_USE for a model of one photograph. */
status network_open_several(const char *weights, network **out);
/* Changes the number type of further computations, so that both types' results can be compared. */
void network_compute_in(network *n, nn_type type);
void network_close(network *n);
const model_config *network_config(const network *n);

/* Compiles programs now, so that the time can be measured separately: that for maps in so many views of this size, and
 * those of network_indirect, network_lights and network_normals. Programs of the last size are kept. The one for
 * bounces needs the most memory, which programs compiled later share. */
status network_prepare(network *n, int size, int views);
status network_prepare_bounces(network *n, int size);
status network_prepare_lights(network *n, int size);
status network_prepare_normals(network *n, int size);
/* Free the programs and their memory, most of what a network needs, or only those that process photographs; they are
 * compiled again when needed (docs/notes/memory.md). */
void network_release(network *n);
void network_release_maps(network *n);
/* Returns the seconds spent on compiling since the last call. */
double network_take_compile_seconds(network *n);

/* Estimates maps as the mean over the first `views` orientations (1 to 8, optics/orientation.h). photo: 3 channels,
 * radiance (exposure.h), zero outside the mask, which is 0 or 1. how: of the square; the maps are for its lens, or for
 * CAMERA_FOV if it is unknown. stop (may be NULL) is called between orientations. */
status network_estimate(network *n, const img *photo, const img *mask, const sight *how, int views, int (*stop)(void),
                        network_estimation *out);
/* Does the same without further processing: normals of several views are their sum, not unit, maps have arbitrary
 * values outside the mask, and depth is that of a lens of CAMERA_FOV, or relief for any lens (sight.h). */
status network_see(network *n, const img *photo, const img *mask, const sight *how, int views, int (*stop)(void),
                   network_estimation *out);
/* Estimates only the light of the photograph, as network_estimate's first view does: MERLIN_WRONG_USE unless it is a
 * model of any light. */
status network_lights(network *n, const img *photo, const img *mask, const sight *how, float lights[MODEL_LIGHTS]);
/* Estimates the maps of an object from several photographs that one camera made of it from one place, each under
 * another light: photos, `count` of them, up to NN_LARGEST_GROUP, one exposure for each. lights (may be NULL) receives
 * each photograph's; out has those of the first. A model of one photograph gives the mean of the maps that it makes of
 * each. MERLIN_WRONG_USE for a model of flashes. */
status network_estimate_several(network *n, const img *photos, int count, const img *mask, const sight *how, int views,
                                int (*stop)(void), float (*lights)[MODEL_LIGHTS], network_estimation *out);
/* Estimates how far normals depend on which photographs are seen (network_estimation's spread), by a model that sees
 * them together; of one that sees them one by one network_estimate_several tells it. photos as there, two or more.
 * MERLIN_WRONG_USE for other models. */
status network_spread_several(network *n, const img *photos, int count, const img *mask, const sight *how, img *spread);
/* Estimates only the lights of several photographs, seen together; photos as for network_estimate_several.
 * MERLIN_WRONG_USE unless the model sees several. */
status network_lights_several(network *n, const img *photos, int count, const img *mask, const sight *how, int views,
                              int (*stop)(void), float (*lights)[MODEL_LIGHTS]);
void network_estimation_free(network_estimation *e);
/* Estimates only the normals, as network_estimate does, for the detail of a larger picture. */
status network_normals(network *n, const img *photo, const img *mask, const sight *how, int views, int (*stop)(void),
                       img *normal);

/* Features of a photograph for the relighting decoder in its first `views` orientations, which do not depend on the
 * light; photo and mask as for network_estimate. MERLIN_WRONG_USE if the model has no such decoder. */
typedef struct network_features network_features;
status network_features_new(network *n, const img *photo, const img *mask, const sight *how, int views,
                            network_features **out);
void network_features_free(network_features *features);

/* Renders that photograph under another light by the relighting decoder of the same network, as the mean over the
 * orientations, without bounces. MERLIN_WRONG_USE if the light has an environment and the model does not support it. */
status network_relight(network *n, const network_features *features, const illumination *light, img *direct);

/* Estimates bounces 2 and up for a surface whose bounce 1 is `direct` (any range; clipped as in training) under point
 * lights, and `environment` (diffuse only; may be NULL) under an environment. */
status network_indirect(network *n, const surface *maps, const img *direct, const img *environment, img *indirect);

#endif
