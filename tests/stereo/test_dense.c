/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/rng.h"
#include "stereo/algebra/dense.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

static const int sizes[] = {1, 2, 3, 4, 7, 24, 97, 200};
enum { SIZES = sizeof sizes / sizeof *sizes, LARGEST = 200 };

/* Symmetric, its numbers in -1 to 1. */
static double *matrix_new(int n, uint64_t seed)
{
    double *m = calloc((size_t)(n * n), sizeof *m);
    rng r = rng_at(seed, (uint64_t)n, 0);
    assert_non_null(m);
    for (int i = 0; i < n; i++)
        for (int j = 0; j <= i; j++)
            m[i * n + j] = m[j * n + i] = (double)rng_range(&r, -1, 1);
    return m;
}

/* Zeros below the diagonal tell that only what is above it is read. */
static double *upper_half_of(const double *m, int n)
{
    double *half = calloc((size_t)(n * n), sizeof *half);
    assert_non_null(half);
    for (int i = 0; i < n; i++)
        memcpy(half + i * n + i, m + i * n + i, (size_t)(n - i) * sizeof *half);
    return half;
}

/* The most that m v - λ v and vᵀ v - 1 differ from nothing, over all columns v of `vectors`. */
static double residual_of(const double *m, const double *vectors, const double *value, int n)
{
    double most = 0;
    for (int k = 0; k < n; k++)
        for (int i = 0; i < n; i++) {
            double product = 0, together = 0;
            for (int j = 0; j < n; j++) {
                product += m[i * n + j] * vectors[j * n + k];
                together += vectors[j * n + i] * vectors[j * n + k];
            }
            most = fmax(most, fabs(product - value[k] * vectors[i * n + k]));
            most = fmax(most, fabs(together - (i == k)));
        }
    return most;
}

static void check_eigen(const double *m, int n, double tolerance)
{
    double value[2 * LARGEST], alone[2 * LARGEST];
    double *vectors = upper_half_of(m, n), *again = upper_half_of(m, n);
    assert_true(dense_eigen(vectors, n, true, value));
    assert_true(residual_of(m, vectors, value, n) < tolerance);
    assert_true(dense_eigen(again, n, false, alone));
    for (int k = 0; k < n; k++) {
        assert_true(k == 0 || value[k] >= value[k - 1]);
        assert_true(fabs(alone[k] - value[k]) < tolerance);
    }
    free(vectors);
    free(again);
}

static void eigenvectors_of_any_size_are_those_of_the_matrix(void **state)
{
    (void)state;
    for (int s = 0; s < SIZES; s++) {
        double *m = matrix_new(sizes[s], 5);
        check_eigen(m, sizes[s], 1e-12 * (sizes[s] + 1));
        free(m);
    }
}

/* 2 on the diagonal and -1 beside it: 2 - 2 cos(k π / (n + 1)), a formula. */
static void eigenvalues_of_a_chain_are_those_of_the_formula(void **state)
{
    (void)state;
    enum { N = 50 };
    double m[N * N] = {0}, value[2 * N];
    for (int i = 0; i < N; i++) {
        m[i * N + i] = 2;
        if (i + 1 < N) m[i * N + i + 1] = -1;
    }
    assert_true(dense_eigen(m, N, false, value));
    for (int k = 0; k < N; k++)
        assert_true(fabs(value[k] - (2 - 2 * cos((k + 1) * 3.14159265358979323846 / (N + 1)))) < 1e-13);
}

/* Pictures of a surface under n lights: three numbers far from 0, the others there by rounding. */
static void matrices_of_low_rank_have_eigenvalues_of_zero(void **state)
{
    (void)state;
    enum { N = 24 };
    double m[N * N] = {0}, value[2 * N];
    double *from = matrix_new(N, 9);
    for (int i = 0; i < N * N; i++)
        for (int k = 0; k < 3; k++)
            m[i] += from[i / N * N + k] * from[i % N * N + k];
    check_eigen(m, N, 1e-12);
    assert_true(dense_eigen(m, N, false, value));
    assert_true(fabs(value[N - 4]) < 1e-13);
    assert_true(value[N - 3] > 0.1);
    free(from);
}

static void plain_matrices_are_no_trouble(void **state)
{
    (void)state;
    double zero[36] = {0}, one[36] = {0}, far[9] = {1e150, 0, 0, 0, 1e-150, 1e-160, 0, 1e-160, 0};
    for (int i = 0; i < 6; i++)
        one[7 * i] = 1;
    check_eigen(zero, 6, 1e-15);
    check_eigen(one, 6, 1e-15);
    double value[6];
    assert_true(dense_eigen(far, 3, false, value));
    assert_true(value[2] == 1e150);
}

static void what_is_not_a_number_has_no_eigenvalues(void **state)
{
    (void)state;
    double m[9] = {1, 0, NAN, 0, 1, 0, 0, 0, 1}, large[9] = {1, 0, 0, 0, HUGE_VAL, 0, 0, 0, 1}, value[6];
    assert_false(dense_eigen(m, 3, true, value));
    assert_false(dense_eigen(large, 3, false, value));
}

/* m mᵀ + 1, and a right side for a known answer. */
static void positive_matrices_are_solved(void **state)
{
    (void)state;
    for (int s = 0; s < SIZES; s++) {
        int n = sizes[s];
        double *from = matrix_new(n, 3), *m = calloc((size_t)(n * n), sizeof *m), b[LARGEST] = {0};
        assert_non_null(m);
        for (int i = 0; i < n * n; i++) {
            m[i] = i % (n + 1) == 0;
            for (int k = 0; k < n; k++)
                m[i] += from[i / n * n + k] * from[i % n * n + k];
        }
        for (int i = 0; i < n * n; i++)
            b[i / n] += m[i] * (1 + i % n);
        for (int i = 0; i < n * n; i++)
            if (i % n > i / n) m[i] = NAN; /* the upper half is not read */
        assert_true(dense_solve_positive(m, n, b));
        for (int i = 0; i < n; i++)
            assert_true(fabs(b[i] - (1 + i)) < 1e-11 * n);
        free(from);
        free(m);
    }
}

static void matrices_that_are_not_positive_are_refused(void **state)
{
    (void)state;
    double m[4] = {1, 0, 2, 1}, zero[1] = {0}, none[25] = {1, 0, 0, 0, 0, 0, NAN}, b[5] = {1, 1};
    assert_false(dense_solve_positive(m, 2, b));
    assert_false(dense_solve_positive(zero, 1, b));
    assert_false(dense_solve_positive(none, 5, b));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(eigenvectors_of_any_size_are_those_of_the_matrix),
        cmocka_unit_test(eigenvalues_of_a_chain_are_those_of_the_formula),
        cmocka_unit_test(matrices_of_low_rank_have_eigenvalues_of_zero),
        cmocka_unit_test(plain_matrices_are_no_trouble),
        cmocka_unit_test(what_is_not_a_number_has_no_eigenvalues),
        cmocka_unit_test(positive_matrices_are_solved),
        cmocka_unit_test(matrices_that_are_not_positive_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
