/* SPDX-License-Identifier: MIT */
#include "image/metadata/box_file.h"

#include <string.h>

uint64_t box_number(byte_source *from, uint64_t at, int bytes)
{
    unsigned char b[8];
    uint64_t number = 0;
    if (byte_source_read(from, at, b, (size_t)bytes) != (size_t)bytes) return 0;
    for (int i = 0; i < bytes; i++)
        number = number << 8 | b[i];
    return number;
}

bool box_name_is(byte_source *from, uint64_t at, const char name[4])
{
    char found[4];
    return byte_source_read(from, at, found, 4) == 4 && memcmp(found, name, 4) == 0;
}

/* Reads the header of the box at a position. */
static bool read_box(byte_source *from, uint64_t at, uint64_t end, media_box *out)
{
    if (at + 8 > end) return false;
    uint64_t size = box_number(from, at, 4), head = 8;
    if (size == 1) {
        size = box_number(from, at + 8, 8);
        head = 16;
    }
    if (size == 0) size = end - at;
    if (size < head || size > end - at) return false;
    *out = (media_box){at + head, at + size};
    return true;
}

/* Finds a box; its name follows four bytes of size in every variant. */
bool box_find(byte_source *from, media_box in, const char name[4], media_box *out)
{
    uint64_t at = in.at;
    for (int i = 0; i < BOX_MOST_STEPS && read_box(from, at, in.end, out); i++) {
        if (box_name_is(from, at + 4, name)) return true;
        at = out->end;
    }
    return false;
}

/* Reads the colour property with this number, counted from 1, if it is stated by code points. */
static bool read_property(byte_source *from, media_box properties, uint64_t place, int numbers[3])
{
    uint64_t at = properties.at;
    media_box one;
    for (uint64_t i = 1; i < place; i++) {
        if (!read_box(from, at, properties.end, &one)) return false;
        at = one.end;
    }
    if (!read_box(from, at, properties.end, &one) || !box_name_is(from, at + 4, "colr") ||
        !box_name_is(from, one.at, "nclx"))
        return false;
    for (uint64_t k = 0; k < 3; k++)
        numbers[k] = (int)box_number(from, one.at + 4 + 2 * k, 2);
    return true;
}

/* Searches the table that associates items with properties. */
static bool find_colour(byte_source *from, media_box table, media_box properties, uint64_t item, int numbers[3])
{
    enum { MOST_PLACES = 512 };
    int bytes = box_number(from, table.at, 1) ? 4 : 2, wide = box_number(from, table.at + 3, 1) & 1 ? 2 : 1;
    uint64_t items = box_number(from, table.at + 4, 4), at = table.at + 8;
    for (uint64_t i = 0; i < items && i < BOX_MOST_STEPS && at < table.end; i++) {
        bool meant = box_number(from, at, bytes) == item;
        uint64_t count = box_number(from, at + (uint64_t)bytes, 1);
        at += (uint64_t)bytes + 1;
        for (uint64_t k = 0; meant && k < count; k++) {
            uint64_t place = box_number(from, at + k * (uint64_t)wide, wide) & (wide == 2 ? 0x7fff : 0x7f);
            if (place && place < MOST_PLACES && read_property(from, properties, place, numbers)) return true;
        }
        if (meant) return false;
        at += count * (uint64_t)wide;
    }
    return false;
}

bool box_read_colour(byte_source *from, int numbers[3])
{
    media_box meta, meant, all, properties, table;
    if (!box_find(from, (media_box){0, INT64_MAX}, "meta", &meta)) return false;
    meta.at += 4;
    if (!box_find(from, meta, "pitm", &meant) || !box_find(from, meta, "iprp", &all)) return false;
    uint64_t item = box_number(from, meant.at + 4, box_number(from, meant.at, 1) ? 4 : 2);
    return box_find(from, all, "ipco", &properties) && box_find(from, all, "ipma", &table) &&
           find_colour(from, table, properties, item, numbers);
}
