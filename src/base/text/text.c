/* SPDX-License-Identifier: MIT */
#include "base/text/text.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"

typedef enum encoding { BYTES, LITTLE_ENDIAN_16, BIG_ENDIAN_16 } encoding;

static encoding encoding_of(const unsigned char *b, size_t size, size_t *mark)
{
    *mark = size >= 2 ? 2 : 0;
    if (size >= 2 && b[0] == 0xff && b[1] == 0xfe) return LITTLE_ENDIAN_16;
    if (size >= 2 && b[0] == 0xfe && b[1] == 0xff) return BIG_ENDIAN_16;
    *mark = 0;
    if (size >= 4 && b[0] && !b[1] && b[2] && !b[3]) return LITTLE_ENDIAN_16;
    if (size >= 4 && !b[0] && b[1] && !b[2] && b[3]) return BIG_ENDIAN_16;
    *mark = file_text_mark((const char *)b, size);
    return BYTES;
}

static char *put_utf8(uint32_t c, char *to)
{
    if (c < 0x80) {
        *to++ = (char)c;
        return to;
    }
    int more = c < 0x800 ? 1 : c < 0x10000 ? 2 : 3;
    static const unsigned char first[] = {0, 0xc0, 0xe0, 0xf0};
    *to++ = (char)(first[more] | c >> 6 * more);
    while (more-- > 0)
        *to++ = (char)(0x80 | (c >> 6 * more & 0x3f));
    return to;
}

static uint32_t unit_at(const unsigned char *b, encoding e)
{
    return e == BIG_ENDIAN_16 ? (uint32_t)b[0] << 8 | b[1] : (uint32_t)b[1] << 8 | b[0];
}

/* Decodes UTF-16 to UTF-8. An odd last byte is ignored. */
static size_t decode_units(const unsigned char *b, size_t size, encoding e, char *to)
{
    const char *begin = to;
    for (size_t i = 0; i + 1 < size; i += 2) {
        uint32_t c = unit_at(b + i, e), low = i + 3 < size ? unit_at(b + i + 2, e) : 0;
        bool high = c >= 0xd800 && c < 0xdc00, pair = high && low >= 0xdc00 && low < 0xe000;
        if (pair) {
            c = 0x10000 + ((c - 0xd800) << 10) + (low - 0xdc00);
            i += 2;
        } else if (c >= 0xd800 && c < 0xe000) {
            c = 0xfffd;
        }
        to = put_utf8(c, to);
    }
    return (size_t)(to - begin);
}

/* Control-Z, with which DOS and some later programs end a text. */
enum { END_OF_TEXT = 0x1a };

/* Normalizes line ends and some characters in place, which only shortens the text; refuses zero bytes. */
static status make_plain(char *text, size_t size, const char *where)
{
    static const char minus[] = "\xe2\x88\x92", blank[] = "\xc2\xa0";
    char *to = text;
    int line = 1;
    for (size_t i = 0; i < size; i++) {
        char c = text[i];
        if (c == END_OF_TEXT && i + 1 == size) break;
        if (!c) return fail(MERLIN_BAD_INPUT, "%s:%d: not a text file", where, line);
        if (c == '\r') {
            c = '\n';
            i += i + 1 < size && text[i + 1] == '\n';
        } else if (size - i >= 3 && memcmp(text + i, minus, 3) == 0) {
            c = '-';
            i += 2;
        } else if (size - i >= 2 && memcmp(text + i, blank, 2) == 0) {
            c = ' ';
            i += 1;
        }
        line += c == '\n';
        *to++ = c;
    }
    *to = 0;
    return OK;
}

status text_decode(const char *bytes, size_t size, const char *where, char **out)
{
    size_t mark;
    const unsigned char *b = (const unsigned char *)bytes;
    encoding e = encoding_of(b, size, &mark);
    size_t room = size - mark; /* two bytes become three at most */
    char *text = malloc(room + room / 2 + 1);
    if (!text) return fail(MERLIN_NO_MEMORY, "no memory for %s", where);
    if (e != BYTES)
        room = decode_units(b + mark, room, e, text);
    else if (room)
        memcpy(text, bytes + mark, room);
    status s = make_plain(text, room, where);
    if (s == OK)
        *out = text;
    else
        free(text);
    return s;
}
