/* The trained networks of one weights file, compiled when first needed and kept for the next photograph.
 *
 *     network *n;
 *     status s = network_open("merlin-point.safetensors", &n);
 *     s = network_estimate(n, &photo, &mask, &maps, &indirect);
 *     network_close(n);
 *
 * Images are square, a multiple of 32 pixels a side, linear. Calls from several threads take turns. */
#ifndef MERLIN_ESTIMATE_NETWORK_H
#define MERLIN_ESTIMATE_NETWORK_H

#include "base/vec.h"
#include "estimate/surface.h"
#include "image/image.h"
#include "model/model.h"

enum { NETWORK_LEAST_SIZE = 64, NETWORK_LARGEST_SIZE = 1024 };

typedef struct network network;

/* ERROR_INPUT for a file that is no weights file of merlin. Computes in bfloat16 where the processor does. */
status network_open(const char *weights, network **out);
void network_close(network *n);
const model_config *network_config(const network *n);

/* Makes the programs for this size now, so that the time is seen apart. */
status network_prepare(network *n, int size);
/* Seconds spent on making programs since the last call. */
double network_take_compile_seconds(network *n);

/* photo: 3 channels, radiance (exposure.h), zero outside the mask, which is 0 or 1. *indirect: the light
 * of bounces 2 and up under the flash; zero for a model without global illumination. */
status network_estimate(network *n, const img *photo, const img *mask, surface *maps, img *indirect);

/* The same photograph under another point light, by the relighting decoder; without bounces. ERROR_USAGE if the model
 * has none or it does not take point lights. */
status network_relight(network *n, const img *photo, const img *mask, vec3 light, img *direct);

/* Bounces 2 and up for a surface whose bounce 1 is `direct` (any range; clipped as in training). */
status network_indirect(network *n, const surface *maps, const img *direct, img *indirect);

#endif
