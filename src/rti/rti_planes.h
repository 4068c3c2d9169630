/* SPDX-License-Identifier: MIT */
/* Planes of coefficients as codes of 8 bits: a value is (code / 255 - bias) × scale.
 *
 * The code that stands for 0 is a whole number, so that what is black remains black. */
#ifndef MERLIN_RTI_RTI_PLANES_H
#define MERLIN_RTI_RTI_PLANES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "merlin/rti.h"

/* Values that are computed a row at a time, more than once and by several threads. */
typedef struct rti_values {
    int width, height, planes;
    int plain;   /* so many planes, the first, hold values in [0, 1] that are written as they are */
    bool shared; /* the 3 planes of a term have one scale and bias */
    void (*row)(const void *context, int y, float *values); /* width × planes */
    const void *context;
} rti_values;

typedef struct rti_planes {
    int width, height, planes;
    uint8_t *codes; /* height × width × planes */
    float scale[MERLIN_RTI_MOST_PLANES];
    int zero[MERLIN_RTI_MOST_PLANES]; /* the code of 0, which is bias × 255 */
} rti_planes;

/* Codes the values in a range that holds them all and 0, so that no value is off by more than its plane's scale / 510.
 */
status rti_planes_new(const rti_values *values, rti_planes *out);
void rti_planes_free(rti_planes *planes);

#endif
