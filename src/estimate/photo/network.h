/* SPDX-License-Identifier: MIT */
/* The trained networks of one weights file, compiled when first needed and kept for the next photograph.
 *
 *     network *n;
 *     status s = network_open("merlin-point.safetensors", &n);
 *     s = network_estimate(n, &photo, &mask, &how, NETWORK_VIEWS, NULL, &estimation);
 *     network_close(n);
 *
 * Images are square, a multiple of 32 pixels a side, linear. Calls from several threads take turns. */
#ifndef MERLIN_ESTIMATE_PHOTO_NETWORK_H
#define MERLIN_ESTIMATE_PHOTO_NETWORK_H

#include "estimate/surface/estimation.h"
#include "estimate/surface/sight.h"
#include "optics/light.h"

/* The shipped weights were last trained at NETWORK_SIZE. Of pictures a little larger they see fine shape well, and
 * coarse shape badly (detail.h). */
enum { NETWORK_LEAST_SIZE = 64, NETWORK_SIZE = 256, NETWORK_LARGEST_SIZE = 512 };

/* Number of orientations in which it sees a photograph unless told otherwise: beside one, four cost 55 ms on top of an
 * estimate's 145, and leave five to ten per cent less error (docs/notes/several_views.md). */
enum { NETWORK_VIEWS = 4 };

/* Of the picture that is seen for all but fine shape, where `size` is asked for. */
static inline int network_side(int size)
{
    return size < NETWORK_SIZE ? size : NETWORK_SIZE;
}

typedef struct network network;

/* MERLIN_BAD_INPUT for a file that is no weights file of merlin. Computes in nn_fastest_type, */
status network_open(const char *weights, network **out);
/* The configuration alone; the parameters, most of the file, are read when a program is first made. */
status network_open_later(const char *weights, network **out);
/* or from now on in another number type, so that figures of both can be compared. */
void network_compute_in(network *n, nn_type type);
void network_close(network *n);
const model_config *network_config(const network *n);

/* Makes a program now, so that the time is seen apart: that of so many views' maps at this size, those of
 * network_indirect, network_lights and network_normals. Those of the last size are kept. That of bounces needs most
 * memory, which all that are made later share. */
status network_prepare(network *n, int size, int views);
status network_prepare_bounces(network *n, int size);
status network_prepare_lights(network *n, int size);
status network_prepare_normals(network *n, int size);
/* Frees the programs and what memory they hold, most of a network's, or those alone that see photographs; they are made
 * anew when they are asked for (docs/notes/memory.md). */
void network_release(network *n);
void network_release_maps(network *n);
/* Seconds spent on making programs since the last call. */
double network_take_compile_seconds(network *n);

/* how: of the square; the maps are for its lens, that of CAMERA_FOV where it is not known. photo: 3 channels, radiance
 * (exposure.h), zero outside the mask, which is 0 or 1. The mean of what the network says of its first `views`
 * orientations (1 to 8, optics/orientation.h). stop (may be NULL) is asked between them. */
status network_estimate(network *n, const img *photo, const img *mask, const sight *how, int views, int (*stop)(void),
                        network_estimation *out);
/* The same before anything is made of it: normals of several views are their sum, not unit, maps hold anything outside
 * the mask, and depth is that of a lens of CAMERA_FOV, or relief for any lens (sight.h). */
status network_see(network *n, const img *photo, const img *mask, const sight *how, int views, int (*stop)(void),
                   network_estimation *out);
/* Tells what lit the photograph alone, as network_estimate's first view does: MERLIN_WRONG_USE unless it is a model of
 * any light. */
status network_lights(network *n, const img *photo, const img *mask, const sight *how, float lights[MODEL_LIGHTS]);
void network_estimation_free(network_estimation *e);
/* The normals alone, as of network_estimate: for what is fine in a larger picture. */
status network_normals(network *n, const img *photo, const img *mask, const sight *how, int views, int (*stop)(void),
                       img *normal);

/* What the relighting decoder takes of a photograph in its first `views` orientations, whatever the light; photo and
 * mask as of network_estimate. MERLIN_WRONG_USE if the model has no such decoder. */
typedef struct network_look network_look;
status network_look_new(network *n, const img *photo, const img *mask, const sight *how, int views, network_look **out);
void network_look_free(network_look *look);

/* That photograph under other light, by the relighting decoder of the same network, the mean of the look's
 * orientations; without bounces. MERLIN_WRONG_USE if the model does not take environments. */
status network_relight(network *n, const network_look *look, const illumination *light, img *direct);

/* Bounces 2 and up for a surface whose bounce 1 is `direct` (any range; clipped as in training) under point lights and
 * `environment` (diffuse only; may be NULL) under an environment. */
status network_indirect(network *n, const surface *maps, const img *direct, const img *environment, img *indirect);

#endif
