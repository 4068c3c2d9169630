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

/* Returns the text after keyword and method, decompressed; malloc'ed, or NULL. */
static char *unpack(const char *packed, size_t size, size_t *length)
{
    struct libdeflate_decompressor *d = size > 0 && packed[0] == 0 ? libdeflate_alloc_decompressor() : NULL;
    char *text = d ? malloc(EXIF_TEXT_MOST) : NULL;
    bool good =
        text && libdeflate_zlib_decompress(d, packed + 1, size - 1, text, EXIF_TEXT_MOST, length) == LIBDEFLATE_SUCCESS;
    if (d) libdeflate_free_decompressor(d);
    if (good) return text;
    free(text);
    return NULL;
}

static int digit(char c)
{
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

/* Parses a line break, a name, the number of bytes, and their digits in lines. */
static bool parse(const char *text, size_t size, void **exif, size_t *exif_size)
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
    unsigned char *bytes = wanted > 0 && wanted <= EXIF_TEXT_MOST ? malloc(wanted) : NULL;
    if (!bytes) return false;
    for (int high = -1; at < size && got < wanted; at++) {
        int value = digit(text[at]);
        if (value < 0) continue;
        if (high >= 0) bytes[got++] = (unsigned char)(high << 4 | value);
        high = high >= 0 ? -1 : value;
    }
    *exif = bytes;
    *exif_size = got;
    if (got == wanted) return true;
    free(bytes);
    return false;
}

bool exif_text_decode(const void *content, size_t size, bool packed, void **exif, size_t *exif_size)
{
    const char *text = content;
    size_t keyword, length = 0;
    if (!has_keyword(text, size, &keyword)) return false;
    if (!packed) return parse(text + keyword, size - keyword, exif, exif_size);
    char *unpacked = unpack(text + keyword, size - keyword, &length);
    bool found = unpacked && parse(unpacked, length, exif, exif_size);
    free(unpacked);
    return found;
}

static bool decode_at(FILE *file, uint64_t at, size_t size, bool packed, void **exif, size_t *exif_size)
{
    char *content = size <= EXIF_TEXT_MOST ? malloc(size + 1) : NULL;
    bool found = content && fseeko(file, (off_t)at, SEEK_SET) == 0 && fread(content, 1, size, file) == size &&
                 exif_text_decode(content, size, packed, exif, exif_size);
    free(content);
    return found;
}

bool exif_text_find(FILE *file, void **exif, size_t *exif_size)
{
    uint64_t at = 8;
    if (!box_name_is(file, 0, "\x89PNG")) return false;
    for (int i = 0; i < BOX_MOST_STEPS; i++) {
        uint64_t length = box_number(file, at, 4);
        bool packed = box_name_is(file, at + 4, "zTXt");
        if (length > INT32_MAX || box_name_is(file, at + 4, "IEND")) return false;
        if ((packed || box_name_is(file, at + 4, "tEXt")) &&
            decode_at(file, at + 8, (size_t)length, packed, exif, exif_size))
            return true;
        at += 12 + length;
    }
    return false;
}
