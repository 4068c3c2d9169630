/* SPDX-License-Identifier: MIT */
#include "image/primaries.h"

#include <math.h>

static const float srgb[8] = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};

/* Matrix from XYZ to the cone responses of the eye (Lam 1985). */
static const double bradford[9] = {0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296};

static void apply(const double m[9], const double v[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = m[3 * i] * v[0] + m[3 * i + 1] * v[1] + m[3 * i + 2] * v[2];
}

static void multiply(const double a[9], const double b[9], double out[9])
{
    for (int i = 0; i < 9; i++)
        out[i] = a[i / 3 * 3] * b[i % 3] + a[i / 3 * 3 + 1] * b[i % 3 + 3] + a[i / 3 * 3 + 2] * b[i % 3 + 6];
}

bool primaries_invert(const double m[9], double out[9])
{
    double determinant = 0;
    for (int i = 0; i < 9; i++) {
        int r0 = (i % 3 + 1) % 3, r1 = (i % 3 + 2) % 3, c0 = (i / 3 + 1) % 3, c1 = (i / 3 + 2) % 3;
        out[i] = m[3 * r0 + c0] * m[3 * r1 + c1] - m[3 * r0 + c1] * m[3 * r1 + c0];
    }
    for (int k = 0; k < 3; k++)
        determinant += m[k] * out[3 * k];
    if (!(fabs(determinant) > 1e-9)) return false;
    for (int i = 0; i < 9; i++)
        out[i] /= determinant;
    return true;
}

/* Returns the white point at luminance 1. */
static void white_of(const float xy[8], double white[3])
{
    double x = xy[6], y = xy[7];
    white[0] = x / y;
    white[1] = 1;
    white[2] = (1 - x - y) / y;
}

/* Computes the matrix from the primaries to XYZ, scaled so that their sum is white. */
static bool to_xyz(const float xy[8], double m[9])
{
    double inverse[9], white[3], strength[3];
    if (!(xy[7] > 0)) return false;
    for (int k = 0; k < 3; k++) {
        m[k] = xy[2 * k];
        m[3 + k] = xy[2 * k + 1];
        m[6 + k] = 1 - m[k] - m[3 + k];
    }
    if (!primaries_invert(m, inverse)) return false;
    white_of(xy, white);
    apply(inverse, white, strength);
    for (int i = 0; i < 9; i++)
        m[i] *= strength[i % 3];
    return true;
}

static bool adapt_to_srgb(const float xy[8], double m[9])
{
    double from[3], to[3], cones_from[3], cones_to[3], back[9], scaled[9];
    white_of(xy, from);
    white_of(srgb, to);
    apply(bradford, from, cones_from);
    apply(bradford, to, cones_to);
    for (int i = 0; i < 9; i++)
        scaled[i] = bradford[i] * cones_to[i / 3] / cones_from[i / 3];
    if (!primaries_invert(bradford, back)) return false;
    multiply(back, scaled, m);
    return true;
}

bool primaries_to_srgb(const float xy[8], double m[9])
{
    double in[9], out[9], from_xyz[9], adapted[9], adapt[9];
    if (!to_xyz(xy, in) || !to_xyz(srgb, out) || !primaries_invert(out, from_xyz) || !adapt_to_srgb(xy, adapt))
        return false;
    multiply(adapt, in, adapted);
    multiply(from_xyz, adapted, m);
    for (int i = 0; i < 9; i++)
        if (!isfinite(m[i])) return false;
    return true;
}

bool primaries_are_srgb(const float xy[8])
{
    const float rounded = 2e-3f;
    for (int i = 0; i < 8; i++)
        if (!(fabsf(xy[i] - srgb[i]) < rounded)) return false;
    return true;
}
