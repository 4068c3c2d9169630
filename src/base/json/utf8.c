/* SPDX-License-Identifier: MIT */
#include "base/json/utf8.h"

#include <stdlib.h>
#include <string.h>

/* Returns the length of the UTF-8 sequence at the beginning of text; 0 if there is none (RFC 3629: no overlong forms,
 * no surrogates, nothing above U+10FFFF). */
static size_t sequence(const unsigned char *text)
{
    unsigned char first = text[0];
    size_t length = first < 0x80 ? 1 : first < 0xc2 ? 0 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : first < 0xf5 ? 4 : 0;
    if (length < 2) return length;
    unsigned char low = first == 0xe0 ? 0xa0 : first == 0xf0 ? 0x90 : 0x80;
    unsigned char high = first == 0xed ? 0x9f : first == 0xf4 ? 0x8f : 0xbf;
    if (text[1] < low || text[1] > high) return 0;
    for (size_t i = 2; i < length; i++)
        if ((text[i] & 0xc0) != 0x80) return 0;
    return length;
}

char *utf8_valid(const char *text)
{
    static const char unknown[] = "\xef\xbf\xbd";
    char *valid = malloc(3 * strlen(text) + 1), *to = valid;
    if (!valid) return NULL;
    while (*text) {
        size_t length = sequence((const unsigned char *)text);
        const char *from = length ? text : unknown;
        size_t put = length ? length : sizeof unknown - 1;
        memcpy(to, from, put);
        to += put;
        text += length ? length : 1;
    }
    *to = 0;
    return valid;
}
