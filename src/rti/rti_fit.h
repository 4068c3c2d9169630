/* SPDX-License-Identifier: MIT */
/* Coefficients of a basis by least squares, from the sums of its normal equations. */
#ifndef MERLIN_RTI_RTI_FIT_H
#define MERLIN_RTI_RTI_FIT_H

#include "rti/rti_planes.h"
#include "rti/rti_sums.h"

typedef struct rti_fit {
    const merlin_rti *rti;
    float inverse[RTI_MOST_TERMS * RTI_MOST_TERMS]; /* inverse of the products' sums */
} rti_fit;

/* Prepares the fit; the object that values refers to must outlive them. The planes are, of LRGB, a colour and the
 * brightness's terms; else each term's 3 channels. MERLIN_WRONG_USE for too few lights, or lights too much alike. */
status rti_fit_new(const merlin_rti *rti, rti_fit *fit, rti_values *values);

#endif
