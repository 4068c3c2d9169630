/* SPDX-License-Identifier: MIT */
/* The floating-point type of formulas and its constants: float everywhere but in tests, which compile the same headers
 * with MERLIN_REAL double to check derivatives against finite differences. */
#ifndef MERLIN_BASE_REAL_H
#define MERLIN_BASE_REAL_H

#ifndef MERLIN_REAL
#define MERLIN_REAL float
#endif
typedef MERLIN_REAL real;

#define PI ((real)3.14159265358979323846)
/* One degree in radians. */
#define DEGREE ((real)(3.14159265358979323846 / 180))

#endif
