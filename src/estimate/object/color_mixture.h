/* SPDX-License-Identifier: MIT */
/* The colours of a part of a picture, and where they occur: a mixture of Gaussians over colour and place, so that a
 * colour counts most near other pixels of its kind.
 *
 *     mixture m;
 *     mixture_learn(&m, &pixels, part, 1);               from the pixels whose part[i] is 1
 *     mixture_costs(&m, &pixels, INFINITY, cost);        cost[i] of every pixel
 */
#ifndef MERLIN_ESTIMATE_OBJECT_COLOR_MIXTURE_H
#define MERLIN_ESTIMATE_OBJECT_COLOR_MIXTURE_H

#include <stddef.h>
#include <stdint.h>

enum { MIXTURE_VALUES = 5, MIXTURE_MOST = 8 };

/* Red, green, blue, x and y of pixels, an array each. */
typedef struct mixture_pixels {
    float *value[MIXTURE_VALUES];
    size_t count;
} mixture_pixels;

typedef struct gaussian {
    float mean[MIXTURE_VALUES];
    float inverse[MIXTURE_VALUES][MIXTURE_VALUES]; /* inverse of the covariance's Cholesky factor: lower triangle */
    float offset;                                  /* log(sqrt(det) / weight) */
} gaussian;

typedef struct mixture {
    gaussian part[MIXTURE_MOST];
    int count;
} mixture;

/* Fits the mixture to the pixels of a part. A mixture of no pixels costs 0 everywhere. */
void mixture_learn(mixture *m, const mixture_pixels *pixels, const uint8_t *part, uint8_t which);
/* Computes -log of the density, up to a constant. For an additional cost of `shadow` (INFINITY: never) a colour may be
 * brightened, up to three times in light, as a shadow does not change the material. */
void mixture_costs(const mixture *m, const mixture_pixels *pixels, float shadow, float *cost);

#endif
