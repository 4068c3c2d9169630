/* SPDX-License-Identifier: MIT */
#include "rti/rti_fit.h"

#include <string.h>

#include "base/number.h"
#include "stereo/algebra/dense.h"

/* The smallest eigenvalue of the normal equations, as a share of the largest, at which errors of 8 bits still stay
 * below a percent. */
static const double LEAST_EIGENVALUE = 1e-5;

/* ---- the inverse ---- */

static status check_lights(const merlin_rti *rti)
{
    double m[RTI_MOST_TERMS * RTI_MOST_TERMS], value[2 * RTI_MOST_TERMS];
    const int n = rti->terms;
    if (rti->count < n)
        return fail(MERLIN_WRONG_USE, "%d pictures are too few: %s has %d terms, and wants as many", rti->count,
                    rti_basis_name(rti->how.basis), n);
    memcpy(m, rti->gram, sizeof m);
    if (!dense_eigen(m, n, false, value) || value[0] < LEAST_EIGENVALUE * value[n - 1])
        return fail(MERLIN_WRONG_USE,
                    "the lights of these pictures are too much alike for %s: spread them over the "
                    "hemisphere, at several heights",
                    rti_basis_name(rti->how.basis));
    return OK;
}

static status invert(const merlin_rti *rti, float *inverse)
{
    const int n = rti->terms;
    status s = check_lights(rti);
    for (int k = 0; k < n && s == OK; k++) {
        double m[RTI_MOST_TERMS * RTI_MOST_TERMS], column[RTI_MOST_TERMS] = {0};
        memcpy(m, rti->gram, sizeof m);
        column[k] = 1;
        if (!dense_solve_positive(m, n, column)) s = fail(MERLIN_WRONG_USE, "the lights of these pictures are alike");
        for (int j = 0; j < n; j++)
            inverse[k * n + j] = (float)column[j];
    }
    return s;
}

/* ---- a row of pixels ---- */

static void solve(const rti_fit *fit, const float *sums, int channels, float *out)
{
    const int n = fit->rti->terms;
    for (int k = 0; k < n; k++)
        for (int c = 0; c < channels; c++) {
            float sum = 0;
            for (int j = 0; j < n; j++)
                sum += fit->inverse[k * n + j] * sums[j * channels + c];
            out[k * channels + c] = sum;
        }
}

static void row_of_channels(const void *context, int y, float *values)
{
    const rti_fit *fit = context;
    const size_t width = (size_t)fit->rti->width, each = 3 * (size_t)fit->rti->terms;
    const float *sums = fit->rti->sums + (size_t)y * width * each;
    for (size_t x = 0; x < width; x++)
        solve(fit, sums + x * each, 3, values + x * each);
}

/* The colour is that of the mean picture, as bright as the brightest; the brightness fits the three channels best. */
static void one_of_brightness(const rti_fit *fit, const float *sums, uint8_t peak, float *values)
{
    const int n = fit->rti->terms;
    float brightness[RTI_MOST_TERMS] = {0}, squares = 0;
    const float most = max_of(max_of(sums[0], sums[1]), sums[2]);
    memset(values, 0, (3 + (size_t)n) * sizeof *values);
    if (most <= 0) return;
    for (int c = 0; c < 3; c++) {
        values[c] = sums[c] / most * (float)peak / 255;
        squares += values[c] * values[c];
    }
    for (int k = 0; k < n; k++)
        for (int c = 0; c < 3; c++)
            brightness[k] += values[c] / squares * sums[3 * k + c];
    solve(fit, brightness, 1, values + 3);
}

static void row_of_brightness(const void *context, int y, float *values)
{
    const rti_fit *fit = context;
    const merlin_rti *rti = fit->rti;
    const size_t width = (size_t)rti->width, first = (size_t)y * width, terms = (size_t)rti->terms;
    for (size_t x = 0; x < width; x++)
        one_of_brightness(fit, rti->sums + (first + x) * 3 * terms, rti->peak[first + x], values + x * (3 + terms));
}

status rti_fit_new(const merlin_rti *rti, rti_fit *fit, rti_values *values)
{
    const bool one = rti->how.basis == MERLIN_RTI_LRGB;
    fit->rti = rti;
    *values = (rti_values){.width = rti->width,
                           .height = rti->height,
                           .planes = one ? 3 + rti->terms : 3 * rti->terms,
                           .plain = one ? 3 : 0,
                           .row = one ? row_of_brightness : row_of_channels,
                           .context = fit};
    return invert(rti, fit->inverse);
}
