/* SPDX-License-Identifier: MIT */
/* Numbers as text against printf and strtod. */
#include "base/text/decimal.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/rng.h"

#include <cmocka.h>

static const char *text_of(double value, int digits)
{
    static char text[DECIMAL_ROOM + 1];
    char *end = decimal_put(text, value, digits);
    assert_true(end > text && end - text <= DECIMAL_ROOM);
    *end = 0;
    return text;
}

static void well_known_numbers_look_like_printf_s(void **state)
{
    (void)state;
    const double values[] = {0,          1,          -1,      0.5,     10,   100,       0.1,    0.25,
                             -12.75,     1e6,        999999,  9999999, 1e7,  9999999.6, 0.0001, 0.00012345678,
                             0.99999999, 9.99999999, -0.3333, 1e-5,    1e30, INFINITY,  -1e-30, 123456.75,
                             1234567.5};
    for (size_t i = 0; i < sizeof values / sizeof *values; i++)
        for (int digits = 1; digits <= 9; digits++) {
            char expected[64];
            snprintf(expected, sizeof expected, "%.*g", digits, values[i]);
            if (strcmp(text_of(values[i], digits), expected) == 0) continue;
            /* halfway between two values either is right */
            double off = fabs(strtod(text_of(values[i], digits), NULL) - values[i]);
            if (fabs(off - fabs(strtod(expected, NULL) - values[i])) > 1e-9 * fabs(values[i]))
                fail_msg("%s is not %s", text_of(values[i], digits), expected);
        }
}

/* Digits are as near as their number allows, and the text is as short as printf's. */
static void any_number_is_rounded_to_its_digits(void **state)
{
    (void)state;
    rng r = rng_at(1, 2, 3);
    for (int i = 0; i < 200000; i++) {
        int digits = 1 + i % 9;
        double value = ((double)rng_uniform(&r) - 0.5) * pow(10, 12 * (double)rng_uniform(&r) - 5);
        char expected[64];
        int length = snprintf(expected, sizeof expected, "%.*g", digits, value);
        const char *text = text_of(value, digits);
        double unit = pow(10, floor(log10(fabs(value))) - digits + 1);
        if (fabs(strtod(text, NULL) - value) > 0.50001 * unit || (int)strlen(text) > length)
            fail_msg("%.17g with %d digits is %s, not %s", value, digits, text, expected);
    }
}

static void counts_are_exact(void **state)
{
    (void)state;
    const uint32_t counts[] = {0, 1, 9, 10, 4294967295u, 1000000};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        char text[DECIMAL_ROOM + 1], expected[32];
        *decimal_put_count(text, counts[i]) = 0;
        snprintf(expected, sizeof expected, "%u", counts[i]);
        assert_string_equal(text, expected);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(well_known_numbers_look_like_printf_s),
        cmocka_unit_test(any_number_is_rounded_to_its_digits),
        cmocka_unit_test(counts_are_exact),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
