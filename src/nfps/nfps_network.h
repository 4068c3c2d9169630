/* SPDX-License-Identifier: MIT */
/* The network of near lights (model/nfps.h) of a weights file, one scale at a time.
 *
 *     nfps_network *n;
 *     status s = nfps_network_open("merlin-nfps.safetensors", &n);
 *     if (s == OK) s = nfps_network_run(n, &scene, 32, images, NULL, normal);
 *     if (s == OK) s = nfps_network_run(n, &finer, 64, larger_images, larger_normal, finer_normal);
 *     nfps_network_close(n);
 */
#ifndef MERLIN_NFPS_NFPS_NETWORK_H
#define MERLIN_NFPS_NFPS_NETWORK_H

#include "base/status.h"
#include "merlin/stereo.h"
#include "nfps/nfps_inputs.h"

typedef struct merlin_near_network nfps_network;

/* Opens a weights file; MERLIN_BAD_INPUT if it is another model's. */
status nfps_network_open(const char *weights, nfps_network **out);
void nfps_network_close(nfps_network *n);
const char *nfps_network_name(const nfps_network *n);

/* Computes normals in the camera's space, 3 a pixel, zero outside the mask: by the first scale's weights if known is
 * NULL, else from these normals of the scale before. The scene's pixels are size × size, a multiple of 4; images as for
 * nfps_encode, 2 to NN_LARGEST_GROUP pictures. In place is allowed. MERLIN_NO_MEMORY. */
status nfps_network_run(const nfps_network *n, const nfps_scene *scene, int size, const float *images,
                        const float *known, float *normal);

#endif
