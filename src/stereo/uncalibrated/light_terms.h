/* SPDX-License-Identifier: MIT */
/* Residuals of light_fit.h and their derivatives by the matrix. */
#ifndef MERLIN_STEREO_UNCALIBRATED_LIGHT_TERMS_H
#define MERLIN_STEREO_UNCALIBRATED_LIGHT_TERMS_H

#include <stdbool.h>
#include <stddef.h>

#include "stereo/algebra/exact3.h"

enum { LIGHT_UNKNOWNS = 9 };
/* Surfaces that the normals are compared with. */
enum { LIGHT_OUTLINE, LIGHT_EXPECTED, LIGHT_SURFACES };

/* A pixel: its unit vector, the vector's slopes, and the expected unit normals, zero where nothing is expected. */
typedef struct light_point {
    exact3 b, right, up, like[LIGHT_SURFACES];
} light_point;

typedef struct light_terms {
    const vec3 *light, *expected_light; /* the second: unit times confidence; NULL: unknown */
    int count;
    light_point *point;
    size_t points;
    double rough;  /* ordinary residual of integrability */
    double uneven; /* logarithm of a light's strength at which it is half given up that it is as strong as the others */
} light_terms;

/* Normal equations of a step: matrix, whose lower half is set, times step is right. */
typedef struct light_equations {
    double matrix[LIGHT_UNKNOWNS * LIGHT_UNKNOWNS], right[LIGHT_UNKNOWNS];
} light_equations;

/* Returns the sum of the squared residuals at m, HUGE_VAL if m has no inverse; equations, unless NULL, are set to those
 * of Gauss and Newton. */
double light_terms_cost(const light_terms *t, const double m[9], light_equations *equations);

/* Computes the transposed inverse; returns false if there is none. */
bool pst_dual(const double m[9], double out[9]);

#endif
