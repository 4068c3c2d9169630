/* SPDX-License-Identifier: MIT */
#include <float.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "stereo/algebra/dense.h"

enum { MOST_TURNS = 60 }; /* steps for each eigenvalue; two are usual */

static double dot(const double *restrict a, const double *restrict b, size_t n)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

static void add_scaled(double *restrict a, double scale, const double *restrict b, size_t n)
{
    for (size_t i = 0; i < n; i++)
        a[i] += scale * b[i];
}

/* Copies the upper half to the lower; returns false if values are not finite. */
static bool mirror(double *m, size_t n)
{
    bool numbers = true;
    for (size_t i = 0; i < n; i++)
        for (size_t j = i; j < n; j++) {
            numbers &= isfinite(m[i * n + j]) != 0;
            m[j * n + i] = m[i * n + j];
        }
    return numbers;
}

/* ---- to tridiagonal form, by reflections (Householder) ---- */

/* Replaces v by the vector of the reflection that maps it to the first axis, and returns its coordinate there. */
static double find_mirror(double *v, size_t n)
{
    double length = sqrt(dot(v, v, n)), onto = v[0] > 0 ? -length : length;
    v[0] -= onto;
    return onto;
}

/* Returns the factor of v vᵀ in the reflection I - factor v vᵀ; 0 if v is zero and reflects nothing. */
static double share_of(const double *v, size_t n)
{
    double square = dot(v, v, n);
    return square > 0 ? 2 / square : 0;
}

/* Reflects the trailing n rows and columns of a matrix with `stride` columns on both sides; w is scratch. */
static void reflect_both(double *m, size_t stride, const double *v, double *w, size_t n)
{
    double share = share_of(v, n);
    for (size_t i = 0; i < n; i++)
        w[i] = share * dot(m + i * stride, v, n);
    add_scaled(w, -share / 2 * dot(w, v, n), v, n);
    for (size_t i = 0; i < n; i++) {
        add_scaled(m + i * stride, -v[i], w, n);
        add_scaled(m + i * stride, -w[i], v, n);
    }
}

/* Computes the diagonal and, in the n numbers behind it, the subdiagonal; the reflections' vectors stay in m's rows
 * behind the diagonal. */
static void reduce(double *m, size_t n, double *diagonal)
{
    double *beside = diagonal + n;
    for (size_t k = 0; k + 2 < n; k++) {
        size_t left = n - k - 1;
        double *v = m + k * n + k + 1;
        diagonal[k] = m[k * n + k];
        beside[k] = find_mirror(v, left);
        reflect_both(m + (k + 1) * (n + 1), n, v, beside + k + 1, left);
    }
    for (size_t k = n > 2 ? n - 2 : 0; k < n; k++) {
        diagonal[k] = m[k * n + k];
        beside[k] = k + 1 < n ? m[k * n + k + 1] : 0;
    }
}

/* Multiplies the reflections to the matrix that makes m tridiagonal, with a row for each future eigenvector. */
static void multiply_out(double *m, size_t n)
{
    for (size_t k = n; k-- > 0;) {
        size_t left = n - k - 1;
        double *v = m + k * n + k + 1, share = k + 2 < n ? share_of(v, left) : 0;
        for (size_t i = k + 1; share > 0 && i < n; i++)
            add_scaled(m + i * n + k + 1, -share * dot(m + i * n + k + 1, v, left), v, left);
        memset(v, 0, left * sizeof *v);
        for (size_t i = k + 1; i < n; i++)
            m[i * n + k] = 0;
        m[k * n + k] = 1;
    }
}

/* ---- to diagonal form, by rotations (implicit QR steps) ---- */

static void rotate_rows(double *restrict a, double *restrict b, double c, double s, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        double x = a[i], y = b[i];
        a[i] = c * x + s * y;
        b[i] = c * y - s * x;
    }
}

/* Returns the eigenvalue of the last two rows and columns that is closer to the last number (Wilkinson). */
static double shift_of(const double *d, const double *e, size_t last)
{
    double half = (d[last - 1] - d[last]) / 2, beside = e[last - 1];
    double root = hypot(half, beside), below = half + (half < 0 ? -root : root);
    return below == 0 ? d[last] : d[last] - beside / below * beside;
}

/* Makes one step between the rows first and last; rows: n columns of vectors, or NULL. */
static void step(double *d, double *e, size_t first, size_t last, double *rows, size_t n)
{
    double x = d[first] - shift_of(d, e, last), z = e[first];
    for (size_t k = first; k < last; k++) {
        double r = hypot(x, z), c = r > 0 ? x / r : 1, s = r > 0 ? z / r : 0;
        double a = d[k], b = e[k], g = d[k + 1];
        if (k > first) e[k - 1] = r;
        d[k] = c * c * a + 2 * c * s * b + s * s * g;
        d[k + 1] = s * s * a - 2 * c * s * b + c * c * g;
        e[k] = c * s * (g - a) + (c * c - s * s) * b;
        x = e[k];
        if (k + 1 < last) {
            z = s * e[k + 1];
            e[k + 1] *= c;
        }
        if (rows) rotate_rows(rows + k * n, rows + (k + 1) * n, c, s, n);
    }
}

static bool is_nothing(const double *d, const double *e, size_t k)
{
    return fabs(e[k]) <= DBL_EPSILON * (fabs(d[k]) + fabs(d[k + 1])) + DBL_MIN;
}

static bool diagonalize(double *d, size_t n, double *rows)
{
    double *e = d + n;
    size_t last = n - 1;
    for (size_t turns = 0; last > 0 && turns < MOST_TURNS * n; turns++) {
        while (last > 0 && is_nothing(d, e, last - 1))
            last--;
        size_t first = last;
        while (first > 0 && !is_nothing(d, e, first - 1))
            first--;
        if (first < last) step(d, e, first, last, rows, n);
    }
    return last == 0;
}

/* ---- the result ---- */

static void sort(double *value, size_t n, double *rows)
{
    for (size_t i = 0; i + 1 < n; i++) {
        size_t least = i;
        for (size_t k = i + 1; k < n; k++)
            if (value[k] < value[least]) least = k;
        if (least == i) continue;
        double swapped = value[i];
        value[i] = value[least];
        value[least] = swapped;
        for (size_t k = 0; rows && k < n; k++) {
            swapped = rows[i * n + k];
            rows[i * n + k] = rows[least * n + k];
            rows[least * n + k] = swapped;
        }
    }
}

static void transpose(double *m, size_t n)
{
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < i; j++) {
            double swapped = m[i * n + j];
            m[i * n + j] = m[j * n + i];
            m[j * n + i] = swapped;
        }
}

bool dense_eigen(double *m, int n, bool vectors, double *value)
{
    size_t size = (size_t)n;
    if (n < 1 || !mirror(m, size)) return false;
    reduce(m, size, value);
    if (vectors) multiply_out(m, size);
    if (!diagonalize(value, size, vectors ? m : NULL)) return false;
    sort(value, size, vectors ? m : NULL);
    if (vectors) transpose(m, size);
    return isfinite(value[0]) && isfinite(value[size - 1]);
}
