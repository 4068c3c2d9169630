/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stddef.h>

#include "stereo/algebra/dense.h"

/* Number of rows that are processed together, so that a row which all of them need is read once. */
enum { AT_ONCE = 4 };

static double dot(const double *restrict a, const double *restrict b, size_t n)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

/* Computes the products of four rows, n values apart, with one. */
static void dot_four(const double *restrict a, size_t n, const double *restrict b, size_t length, double sum[AT_ONCE])
{
    const double *restrict a1 = a + n, *restrict a2 = a1 + n, *restrict a3 = a2 + n;
    double s0 = 0, s1 = 0, s2 = 0, s3 = 0;
    for (size_t i = 0; i < length; i++) {
        s0 += a[i] * b[i];
        s1 += a1[i] * b[i];
        s2 += a2[i] * b[i];
        s3 += a3[i] * b[i];
    }
    sum[0] = s0;
    sum[1] = s1;
    sum[2] = s2;
    sum[3] = s3;
}

/* Computes the row's numbers from column `from` on to the diagonal; those before are done. */
static bool finish_row(double *m, size_t n, size_t i, size_t from)
{
    double *row = m + i * n;
    for (size_t j = from; j < i; j++)
        row[j] = (row[j] - dot(row, m + j * n, j)) / m[j * n + j];
    double square = row[i] - dot(row, row, i);
    row[i] = sqrt(square);
    return square > 0 && isfinite(row[i]);
}

/* Factorizes m = L Lᵀ (Cholesky), with L in m's lower half. */
static bool factorize(double *m, size_t n)
{
    size_t i = 0;
    for (; i + AT_ONCE <= n; i += AT_ONCE) {
        double *rows = m + i * n, sum[AT_ONCE];
        for (size_t j = 0; j < i; j++) {
            dot_four(rows, n, m + j * n, j, sum);
            for (size_t k = 0; k < AT_ONCE; k++)
                rows[k * n + j] = (rows[k * n + j] - sum[k]) / m[j * n + j];
        }
        for (size_t k = 0; k < AT_ONCE; k++)
            if (!finish_row(m, n, i + k, i)) return false;
    }
    for (; i < n; i++)
        if (!finish_row(m, n, i, 0)) return false;
    return true;
}

bool dense_solve_positive(double *m, int size, double *b)
{
    size_t n = (size_t)size;
    if (!factorize(m, n)) return false;
    for (size_t i = 0; i < n; i++)
        b[i] = (b[i] - dot(m + i * n, b, i)) / m[i * n + i];
    for (size_t i = n; i-- > 0;) {
        b[i] /= m[i * n + i];
        for (size_t j = 0; j < i; j++)
            b[j] -= m[i * n + j] * b[i];
    }
    return true;
}
