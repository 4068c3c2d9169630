/* SPDX-License-Identifier: MIT */
/* Parses a word of a table as a number: decimal, independent of the locale, with an exponent of e or d. */
#include "base/text/text_number.h"

#include <ctype.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/plain_locale.h"

enum { LONGEST = 400 };

static size_t digits(const char *c)
{
    size_t n = 0;
    while (isdigit((unsigned char)c[n]))
        n++;
    return n;
}

/* Tells whether a word is a decimal number; removes the f that C writes after a float. */
static bool is_decimal(char *word)
{
    char *c = word + (*word == '+' || *word == '-');
    size_t whole = digits(c), part = 0;
    c += whole;
    bool point = *c == '.';
    if (point) part = digits(++c);
    c += part;
    if (whole + part == 0) return false;
    if (*c && strchr("eEdD", *c)) {
        *c++ = 'e';
        c += *c == '+' || *c == '-';
        size_t power = digits(c);
        if (power == 0) return false;
        c += power;
        point = true;
    }
    if (point && (*c == 'f' || *c == 'F') && !c[1]) *c = 0;
    return *c == 0;
}

/* Tells whether a word is a named value such as nan or inf, as C, Python, MATLAB and spreadsheets write them. */
static bool is_named(const char *word)
{
    static const char *const names[] = {"nan", "inf", "infinity", "nan(ind)", "1.#ind", "1.#inf", "1.#qnan"};
    word += *word == '+' || *word == '-';
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcasecmp(word, names[i]) == 0) return true;
    return false;
}

text_kind text_number(const char *word, size_t length, bool comma, double *value)
{
    char copy[LONGEST + 1];
    *value = 0;
    if (length > LONGEST) return TEXT_WORD;
    memcpy(copy, word, length);
    copy[length] = 0;
    if (comma) {
        char *sign = strchr(copy, ',');
        if (sign) *sign = '.';
    }
    if (is_named(copy)) return TEXT_NO_NUMBER;
    if (!is_decimal(copy)) return TEXT_WORD;
    *value = strtod_l(copy, NULL, plain_locale());
    return fabs(*value) <= (double)FLT_MAX ? TEXT_NUMBER : TEXT_NO_NUMBER;
}
