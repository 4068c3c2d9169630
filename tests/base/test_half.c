/* SPDX-License-Identifier: MIT */
/* Compares 16-bit floats with their definitions, over all values. */
#include "base/half.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>

#ifdef __SSE__
#include <xmmintrin.h>
#endif

#include <cmocka.h>

/* Returns the value of sign, exponent and fraction by IEEE 754. */
static double half_by_definition(unsigned h)
{
    double sign = h >> 15 ? -1 : 1;
    int exponent = (int)(h >> 10 & 31), fraction = (int)(h & 1023);
    if (exponent == 31) return fraction ? NAN : sign * INFINITY;
    return exponent == 0 ? sign * ldexp(fraction, -24) : sign * ldexp(1024 + fraction, exponent - 25);
}

static void every_half_has_the_value_of_its_definition(void **state)
{
    (void)state;
    for (unsigned h = 0; h < 65536; h++) {
        double found = (double)half_to_float((uint16_t)h), wanted = half_by_definition(h);
        assert_true(isnan(wanted) ? isnan(found) : found == wanted);
        assert_true(!!signbit(found) == !!signbit(wanted) || isnan(wanted));
    }
}

/* The mode is that of a run of the network. */
static void halves_have_their_values_where_denormals_are_zero(void **state)
{
    (void)state;
#ifdef __SSE__
    enum { FLUSHED = 0x8040, COUNT = 0x400 };
    static float found[COUNT];
    const unsigned before = _mm_getcsr();
    _mm_setcsr(before | FLUSHED);
    for (unsigned h = 0; h < COUNT; h++)
        found[h] = half_to_float((uint16_t)h);
    _mm_setcsr(before);
    for (unsigned h = 0; h < COUNT; h++)
        assert_true((double)found[h] == half_by_definition(h));
#else
    skip();
#endif
}

static void every_half_survives_the_round_trip(void **state)
{
    (void)state;
    for (unsigned h = 0; h < 65536; h++) {
        uint16_t back = float_to_half(half_to_float((uint16_t)h));
        bool nan = (h & 0x7fff) > 0x7c00;
        assert_true(nan ? (back & 0x7fff) > 0x7c00 : back == h);
    }
}

static void every_bfloat16_survives_the_round_trip(void **state)
{
    (void)state;
    for (unsigned h = 0; h < 65536; h++) {
        uint16_t back = float_to_bf16(bf16_to_float((uint16_t)h));
        bool nan = (h & 0x7fff) > 0x7f80;
        assert_true(nan ? (back & 0x7fff) > 0x7f80 : back == h);
    }
}

/* Between neighbours a and b the nearer one is chosen, and in the middle the even one. */
static void halves_round_to_nearest_and_ties_to_even(void **state)
{
    (void)state;
    for (unsigned h = 0; h < 0x7bff; h++) {
        double a = (double)half_to_float((uint16_t)h), b = (double)half_to_float((uint16_t)(h + 1));
        float middle = (float)((a + b) / 2); /* exact, as it needs one more bit */
        unsigned even = h & 1 ? h + 1 : h;
        assert_int_equal(float_to_half(middle), even);
        assert_int_equal(float_to_half(nextafterf(middle, 0)), h);
        assert_int_equal(float_to_half(nextafterf(middle, 1e9f)), h + 1);
        assert_int_equal(float_to_half(-middle), even | 0x8000);
    }
}

static void bfloat16_rounds_to_nearest_and_ties_to_even(void **state)
{
    (void)state;
    for (unsigned h = 0; h < 0x7f7f; h++) {
        float middle = bits_float((uint32_t)h << 16 | 0x8000);
        unsigned even = h & 1 ? h + 1 : h;
        assert_int_equal(float_to_bf16(middle), even);
        assert_int_equal(float_to_bf16(bits_float(float_bits(middle) - 1)), h);
        assert_int_equal(float_to_bf16(bits_float(float_bits(middle) + 1)), h + 1);
    }
}

static void what_is_too_large_becomes_infinite_and_too_small_zero(void **state)
{
    (void)state;
    assert_int_equal(float_to_half(65504), 0x7bff);
    assert_int_equal(float_to_half(65519.996f), 0x7bff);
    assert_int_equal(float_to_half(65520), 0x7c00);
    assert_int_equal(float_to_half(-1e30f), 0xfc00);
    assert_int_equal(float_to_half(INFINITY), 0x7c00);
    assert_int_equal(float_to_half(0x1p-24f), 1);
    assert_int_equal(float_to_half(0x1p-25f), 0);
    assert_int_equal(float_to_half(0x1.000002p-25f), 1);
    assert_int_equal(float_to_half(-1e-30f), 0x8000);
    assert_int_equal(float_to_bf16(3.4e38f), 0x7f80);
    assert_int_equal(float_to_bf16(-INFINITY), 0xff80);
    assert_true(isnan(bf16_to_float(float_to_bf16(NAN))) && isnan(half_to_float(float_to_half(-NAN))));
    /* a NaN with bits only in the lower half must not become infinity */
    assert_true(isnan(bf16_to_float(float_to_bf16(bits_float(0x7f800001)))));
    assert_true(isnan(half_to_float(float_to_half(bits_float(0x7f800001)))));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_half_has_the_value_of_its_definition),
        cmocka_unit_test(halves_have_their_values_where_denormals_are_zero),
        cmocka_unit_test(every_half_survives_the_round_trip),
        cmocka_unit_test(every_bfloat16_survives_the_round_trip),
        cmocka_unit_test(halves_round_to_nearest_and_ties_to_even),
        cmocka_unit_test(bfloat16_rounds_to_nearest_and_ties_to_even),
        cmocka_unit_test(what_is_too_large_becomes_infinite_and_too_small_zero),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
