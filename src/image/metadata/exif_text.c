/* SPDX-License-Identifier: MIT */
#include "image/metadata/exif_text.h"

#include <ctype.h>
#include <libdeflate.h>
#include <stdlib.h>
#include <string.h>

#include "image/metadata/box_file.h"

static bool has_keyword(const char *content, size_t size, size_t *length)
{
    static const char *const keywords[] = {"Raw profile type exif", "Raw profile type APP1"};
    for (size_t i = 0; i < sizeof keywords / sizeof *keywords; i++) {
        *length = strlen(keywords[i]) + 1;
        if (size > *length && memcmp(content, keywords[i], *length) == 0) return true;
    }
    return false;
}

static status lack(void)
{
    return fail(MERLIN_NO_MEMORY, "no memory to read EXIF");
}

/* Decompresses the text after keyword and method; *text is malloc'ed, NULL if it is damaged. */
static status unpack(const char *packed, size_t size, char **text, size_t *length)
{
    *text = NULL;
    if (size == 0 || packed[0] != 0) return OK;
    struct libdeflate_decompressor *d = libdeflate_alloc_decompressor();
    char *room = d ? malloc(EXIF_TEXT_MOST) : NULL;
    const bool enough = room, good = enough && libdeflate_zlib_decompress(d, packed + 1, size - 1, room, EXIF_TEXT_MOST,
                                                                          length) == LIBDEFLATE_SUCCESS;
    if (d) libdeflate_free_decompressor(d);
    if (good)
        *text = room;
    else
        free(room);
    return enough ? OK : lack();
}

static int digit(char c)
{
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

/* Parses a line break, a name, the number of bytes, and their digits in lines. */
static status parse(const char *text, size_t size, void **exif, size_t *exif_size)
{
    size_t at = 0, wanted = 0, got = 0;
    while (at < size && isspace((unsigned char)text[at]))
        at++;
    while (at < size && !isspace((unsigned char)text[at]))
        at++;
    while (at < size && isspace((unsigned char)text[at]))
        at++;
    for (; at < size && text[at] >= '0' && text[at] <= '9' && wanted <= EXIF_TEXT_MOST; at++)
        wanted = 10 * wanted + (size_t)(text[at] - '0');
    if (wanted == 0 || wanted > EXIF_TEXT_MOST) return OK;
    unsigned char *bytes = malloc(wanted);
    if (!bytes) return lack();
    for (int high = -1; at < size && got < wanted; at++) {
        int value = digit(text[at]);
        if (value < 0) continue;
        if (high >= 0) bytes[got++] = (unsigned char)(high << 4 | value);
        high = high >= 0 ? -1 : value;
    }
    if (got == wanted) {
        *exif = bytes;
        *exif_size = got;
    } else {
        free(bytes);
    }
    return OK;
}

status exif_text_decode(const void *content, size_t size, bool packed, void **exif, size_t *exif_size)
{
    const char *text = content;
    size_t keyword, length = 0;
    *exif = NULL;
    if (!has_keyword(text, size, &keyword)) return OK;
    if (!packed) return parse(text + keyword, size - keyword, exif, exif_size);
    char *unpacked;
    status s = unpack(text + keyword, size - keyword, &unpacked, &length);
    if (s == OK && unpacked) s = parse(unpacked, length, exif, exif_size);
    free(unpacked);
    return s;
}

status exif_text_decode_at(byte_source *from, uint64_t at, size_t size, bool packed, void **exif, size_t *exif_size)
{
    *exif = NULL;
    if (size > EXIF_TEXT_MOST) return OK;
    char *content = malloc(size + 1);
    if (!content) return lack();
    const bool there = byte_source_read(from, at, content, size) == size;
    const status s = there ? exif_text_decode(content, size, packed, exif, exif_size) : OK;
    free(content);
    return s;
}

status exif_text_find(byte_source *from, void **exif, size_t *exif_size)
{
    uint64_t at = 8;
    status s = OK;
    *exif = NULL;
    if (!box_name_is(from, 0, "\x89PNG")) return OK;
    for (int i = 0; i < BOX_MOST_STEPS && s == OK && !*exif; i++) {
        uint64_t length = box_number(from, at, 4);
        bool packed = box_name_is(from, at + 4, "zTXt");
        if (length > INT32_MAX || box_name_is(from, at + 4, "IEND")) return OK;
        if (packed || box_name_is(from, at + 4, "tEXt"))
            s = exif_text_decode_at(from, at + 8, (size_t)length, packed, exif, exif_size);
        at += 12 + length;
    }
    return s;
}
