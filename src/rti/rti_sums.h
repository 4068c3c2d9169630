/* SPDX-License-Identifier: MIT */
/* State after some pictures: the sums of least squares' normal equations, or for RBF the pictures.
 */
#ifndef MERLIN_RTI_RTI_SUMS_H
#define MERLIN_RTI_RTI_SUMS_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "rti/rti_basis.h"

struct merlin_rti {
    int width, height, terms;
    merlin_rti_params how; /* nothing in it is 0 for the usual */
    int count;             /* pictures so far */
    float *direction;      /* direction of each picture's light, 3 values, unit */
    uint8_t **pictures;    /* pictures of RBF, each height × width × 3, sRGB; else NULL */
    float *sums;   /* height × width × terms × 3: of the pictures' values, in [0, 1], times each term; or NULL */
    uint8_t *peak; /* largest value of each pixel for LRGB, height × width; else NULL */
    double gram[RTI_MOST_TERMS * RTI_MOST_TERMS]; /* sums of the products of two terms */
};

static inline size_t rti_pixel_count(const merlin_rti *rti)
{
    return (size_t)rti->width * (size_t)rti->height;
}

#endif
