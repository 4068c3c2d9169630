/* SPDX-License-Identifier: MIT */
/* Principal components of the pictures of RBF: a pixel's values under all lights as a sum of a few vectors.
 *
 * They are taken about 0, not about the mean, so that a pixel that is black under all lights remains so. */
#ifndef MERLIN_RTI_RTI_COMPONENTS_H
#define MERLIN_RTI_RTI_COMPONENTS_H

#include "rti/rti_planes.h"
#include "rti/rti_sums.h"

enum { RTI_BASIS_ZERO = 127 };

typedef struct rti_components {
    const merlin_rti *rti;
    int length, planes;                  /* 3 values a picture */
    uint8_t *codes;                      /* planes × length: a vector's value is (code - RTI_BASIS_ZERO) / range */
    float range[MERLIN_RTI_MOST_PLANES]; /* range of each vector */
    float *projection;                   /* length × planes: of pixels onto the vectors as they are coded */
} rti_components;

/* Finds them from a random part of the pixels; the object that values refers to must outlive them. MERLIN_WRONG_USE for
 * too few pictures. */
status rti_components_new(const merlin_rti *rti, rti_components *out, rti_values *values);
void rti_components_free(rti_components *components);
/* Returns the width of the Gaussian that blends between neighbouring lights. */
double rti_sigma(const merlin_rti *rti);

#endif
