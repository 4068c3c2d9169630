/* SPDX-License-Identifier: MIT */
#include "rti/rti_basis.h"

#include <math.h>

/* OpenLIME takes a light that is lower than this, in radians above the horizon, for one that is so high, because the
 * harmonics of degree 1 have an infinite slope at the horizon. */
static const double LEAST_ELEVATION = 0.15;

const char *rti_basis_name(merlin_rti_basis basis)
{
    return basis == MERLIN_RTI_HSH ? "hsh" : basis == MERLIN_RTI_RBF ? "rbf" : "ptm";
}

int rti_term_count(merlin_rti_basis basis)
{
    return basis == MERLIN_RTI_HSH ? 9 : basis == MERLIN_RTI_RBF ? 0 : 6;
}

static void ptm_terms(double x, double y, double terms[RTI_MOST_TERMS])
{
    terms[0] = 1;
    terms[1] = x;
    terms[2] = y;
    terms[3] = x * x;
    terms[4] = x * y;
    terms[5] = y * y;
}

/* Legendre polynomials of 2 cosθ - 1, times sines and cosines of multiples of φ, orthonormal on the hemisphere. */
static void hsh_terms(const float direction[3], double terms[RTI_MOST_TERMS])
{
    const double phi = atan2((double)direction[1], (double)direction[0]);
    const double cosine = fmax((double)direction[2], sin(LEAST_ELEVATION)), shifted = 2 * cosine - 1;
    const double slope = sqrt(cosine - cosine * cosine), bend = cosine * cosine - cosine;
    const double first = sqrt(6 / M_PI), second = sqrt(30 / M_PI);
    terms[0] = 1 / sqrt(2 * M_PI);
    terms[1] = first * cos(phi) * slope;
    terms[2] = sqrt(3 / (2 * M_PI)) * shifted;
    terms[3] = first * sin(phi) * slope;
    terms[4] = second * cos(2 * phi) * bend;
    terms[5] = second * cos(phi) * shifted * slope;
    terms[6] = sqrt(5 / (2 * M_PI)) * (1 + 6 * bend);
    terms[7] = second * sin(phi) * shifted * slope;
    terms[8] = second * sin(2 * phi) * bend;
}

void rti_terms(merlin_rti_basis basis, const float direction[3], double terms[RTI_MOST_TERMS])
{
    if (basis == MERLIN_RTI_HSH)
        hsh_terms(direction, terms);
    else
        ptm_terms((double)direction[0], (double)direction[1], terms);
}
