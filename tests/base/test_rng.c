/* SPDX-License-Identifier: MIT */
#include "base/rng.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>

#include <cmocka.h>

/* Values are from the reference implementation of SplitMix64 started at 0. */
static void the_mixer_is_splitmix64(void **state)
{
    (void)state;
    assert_true(rng_mix(0) == 0xe220a8397b1dcdafu);
    assert_true(rng_mix(0x9e3779b97f4a7c15u) == 0x6e789e6aa1b965f4u);
}

/* Values are from the published demonstration of PCG32: initstate 42, initseq 54. */
static void the_generator_is_pcg32(void **state)
{
    (void)state;
    rng r = {0, 54u << 1 | 1};
    rng_u32(&r);
    r.state += 42;
    rng_u32(&r);
    static const uint32_t published[] = {0xa15c02b7, 0x7b47f409, 0xba1d3330, 0x83d2f293, 0xbfa4784b, 0xcbed606e};
    for (int i = 0; i < 6; i++)
        assert_int_equal(rng_u32(&r), published[i]);
}

static void equal_keys_give_equal_numbers(void **state)
{
    (void)state;
    rng a = rng_at(1, 2, 3), b = rng_at(1, 2, 3);
    for (int i = 0; i < 1000; i++)
        assert_int_equal(rng_u32(&a), rng_u32(&b));
}

/* Of 1000 pairs of 32-bit numbers none should agree: the probability of one is 2e-7. */
static void neighbouring_keys_give_unrelated_numbers(void **state)
{
    (void)state;
    rng a = rng_at(1, 2, 3);
    rng others[] = {rng_at(2, 2, 3), rng_at(1, 3, 3), rng_at(1, 2, 4), rng_at(2, 1, 3), rng_at(1, 3, 2)};
    for (int i = 0; i < 1000; i++) {
        uint32_t x = rng_u32(&a);
        for (int k = 0; k < 5; k++)
            assert_int_not_equal(x, rng_u32(&others[k]));
    }
}

/* 64 cells, 64,000 numbers: χ² has 63 degrees of freedom and exceeds 120 with probability 10^-5 (and the key is fixed).
 */
static void uniform_numbers_fill_their_range_evenly(void **state)
{
    (void)state;
    enum { CELLS = 64, DRAWS = 64000 };
    int count[CELLS] = {0};
    rng r = rng_at(7, 0, 0);
    for (int i = 0; i < DRAWS; i++) {
        float u = rng_uniform(&r);
        assert_true(u >= 0 && u < 1);
        count[(int)(u * CELLS)]++;
    }
    double chi2 = 0, expected = (double)DRAWS / CELLS;
    for (int i = 0; i < CELLS; i++)
        chi2 += (count[i] - expected) * (count[i] - expected) / expected;
    assert_true(chi2 < 120 && chi2 > 25);
}

/* These are the numbers that samples and augmentations use first. */
static void first_draws_of_consecutive_indices_are_uniform(void **state)
{
    (void)state;
    enum { DRAWS = 40000 };
    double sum = 0, product = 0, last = 0.5;
    for (uint64_t i = 0; i < DRAWS; i++) {
        rng r = rng_at(1, i, 0);
        double u = (double)rng_uniform(&r);
        sum += u;
        product += (u - 0.5) * (last - 0.5);
        last = u;
    }
    /* standard errors: √(1/12/N) = 0.0014 and 1/12/√N = 0.0004; four of them */
    assert_true(fabs(sum / DRAWS - 0.5) < 0.006);
    assert_true(fabs(product / DRAWS) < 0.0017);
}

static void whole_numbers_stay_below_their_bound(void **state)
{
    (void)state;
    rng r = rng_at(3, 0, 0);
    bool seen[7] = {false};
    for (int i = 0; i < 1000; i++) {
        int k = rng_below(&r, 7);
        assert_true(k >= 0 && k < 7);
        seen[k] = true;
    }
    for (int k = 0; k < 7; k++)
        assert_true(seen[k]);
    assert_int_equal(rng_below(&r, 1), 0);
}

static void normal_numbers_have_mean_zero_and_variance_one(void **state)
{
    (void)state;
    enum { DRAWS = 100000 };
    double sum = 0, squares = 0;
    rng r = rng_at(5, 0, 0);
    for (int i = 0; i < DRAWS; i++) {
        double x = (double)rng_normal(&r);
        sum += x;
        squares += x * x;
    }
    /* standard errors 1/√N = 0.0032 and √(2/N) = 0.0045; four of them */
    assert_true(fabs(sum / DRAWS) < 0.013 && fabs(squares / DRAWS - 1) < 0.018);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_mixer_is_splitmix64),
        cmocka_unit_test(the_generator_is_pcg32),
        cmocka_unit_test(equal_keys_give_equal_numbers),
        cmocka_unit_test(neighbouring_keys_give_unrelated_numbers),
        cmocka_unit_test(uniform_numbers_fill_their_range_evenly),
        cmocka_unit_test(first_draws_of_consecutive_indices_are_uniform),
        cmocka_unit_test(whole_numbers_stay_below_their_bound),
        cmocka_unit_test(normal_numbers_have_mean_zero_and_variance_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
