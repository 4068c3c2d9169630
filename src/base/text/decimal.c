/* SPDX-License-Identifier: MIT */
#include "base/text/decimal.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/plain_locale.h"

static const double power[] = {1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13};

static char *put_whole(char *to, uint64_t whole, int least_digits)
{
    char digit[24];
    int count = 0;
    for (; whole > 0 || count < least_digits; whole /= 10)
        digit[count++] = (char)('0' + whole % 10);
    while (count > 0)
        *to++ = digit[--count];
    return to;
}

/* Writes what %g would write with an exponent, and values that are not finite. */
static char *put_rare(char *to, double value, int digits)
{
    char text[DECIMAL_ROOM + 8];
    locale_t before = uselocale(plain_locale());
    int length = snprintf(text, sizeof text, "%.*g", digits, value);
    uselocale(before);
    memcpy(to, text, (size_t)length);
    return to + length;
}

char *decimal_put(char *to, double value, int digits)
{
    double size = fabs(value);
    if (size == 0) return put_whole(to, 0, 1);
    if (!(size >= 1e-4 && size < power[digits] - 0.5)) return put_rare(to, value, digits);
    int decimals = digits - 1; /* below 10; each more digit before the point is one less after it */
    while (decimals > 0 && size >= power[digits - decimals])
        decimals--;
    for (int zeros = 0; size * power[zeros] < 1; zeros++)
        decimals++;
    uint64_t scaled = (uint64_t)(size * power[decimals] + 0.5), unit = (uint64_t)power[decimals];
    if (value < 0) *to++ = '-';
    to = put_whole(to, scaled / unit, 1);
    if (scaled % unit == 0) return to;
    *to++ = '.';
    to = put_whole(to, scaled % unit, decimals);
    while (to[-1] == '0')
        to--;
    return to;
}

char *decimal_put_count(char *to, uint32_t count)
{
    return put_whole(to, count, 1);
}
