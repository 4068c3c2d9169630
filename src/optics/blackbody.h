/* SPDX-License-Identifier: MIT */
/* The colour of a black body by its temperature.
 *
 *     vec3 lamp = blackbody_color(2700);      a light bulb
 */
#ifndef MERLIN_OPTICS_BLACKBODY_H
#define MERLIN_OPTICS_BLACKBODY_H

#include "base/vec.h"

/* Returns a Gaussian with different widths left and right of its middle. */
static inline double blackbody_lobe(double x, double middle, double left, double right)
{
    double t = (x - middle) / (x < middle ? left : right);
    return exp(-0.5 * t * t);
}

/* Returns Planck's spectrum in linear sRGB (colour matching functions of the CIE 1931 observer, fitted by lobes: Wyman,
 * Sloan and Shirley 2013), scaled so that the largest channel is 1. Colours outside the sRGB gamut, as below 1900 K,
 * are clipped to it. */
static inline vec3 blackbody_color(double kelvin)
{
    double x = 0, y = 0, z = 0;
    for (int i = 0; i <= 80; i++) {
        double nm = 380 + 5 * i;
        double power = pow(nm / 560, -5) / expm1(1.438776877e7 / (nm * kelvin));
        x += power * (1.056 * blackbody_lobe(nm, 599.8, 37.9, 31.0) + 0.362 * blackbody_lobe(nm, 442.0, 16.0, 26.7) -
                      0.065 * blackbody_lobe(nm, 501.1, 20.4, 26.2));
        y += power * (0.821 * blackbody_lobe(nm, 568.8, 46.9, 40.5) + 0.286 * blackbody_lobe(nm, 530.9, 16.3, 31.1));
        z += power * (1.217 * blackbody_lobe(nm, 437.0, 11.8, 36.0) + 0.681 * blackbody_lobe(nm, 459.0, 26.0, 13.8));
    }
    double r = fmax(3.2404542 * x - 1.5371385 * y - 0.4985314 * z, 0);
    double g = fmax(-0.9692660 * x + 1.8760108 * y + 0.0415560 * z, 0);
    double b = fmax(0.0556434 * x - 0.2040259 * y + 1.0572252 * z, 0);
    double most = fmax(r, fmax(g, b));
    return vec3_make((real)(r / most), (real)(g / most), (real)(b / most));
}

#endif
