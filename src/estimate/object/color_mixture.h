/* SPDX-License-Identifier: MIT */
/* What colours a part of a picture has, and where: a mixture of Gaussians over colour and place, so that a colour
 * counts most beside others of its kind.
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

/* Red, green, blue, x and y of pixels, each of them one array. */
typedef struct mixture_pixels {
    float *value[MIXTURE_VALUES];
    size_t count;
} mixture_pixels;

typedef struct gaussian {
    float mean[MIXTURE_VALUES];
    float inverse[MIXTURE_VALUES][MIXTURE_VALUES]; /* of the covariance's Cholesky factor: lower triangle */
    float offset;                                  /* log(sqrt(det) / weight) */
} gaussian;

typedef struct mixture {
    gaussian part[MIXTURE_MOST];
    int count;
} mixture;

/* A mixture of no pixel costs 0 everywhere. */
void mixture_learn(mixture *m, const mixture_pixels *pixels, const uint8_t *part, uint8_t which);
/* -log of the density, but for a constant. Colours may also be brightened, up to three times in light, for so much more
 * (INFINITY: not at all): what lies in a shadow is what it was. */
void mixture_costs(const mixture *m, const mixture_pixels *pixels, float shadow, float *cost);

#endif
