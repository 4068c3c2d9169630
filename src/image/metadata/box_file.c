/* SPDX-License-Identifier: MIT */
#include "image/metadata/box_file.h"

#include <string.h>

uint64_t box_number(FILE *file, uint64_t at, int bytes)
{
    unsigned char b[8];
    uint64_t number = 0;
    if (at > INT64_MAX || fseeko(file, (off_t)at, SEEK_SET) != 0) return 0;
    if (fread(b, 1, (size_t)bytes, file) != (size_t)bytes) return 0;
    for (int i = 0; i < bytes; i++)
        number = number << 8 | b[i];
    return number;
}

bool box_name_is(FILE *file, uint64_t at, const char name[4])
{
    char found[4];
    return at <= INT64_MAX && fseeko(file, (off_t)at, SEEK_SET) == 0 && fread(found, 1, 4, file) == 4 &&
           memcmp(found, name, 4) == 0;
}

/* Reads the header of the box at a position. */
static bool read_box(FILE *file, uint64_t at, uint64_t end, box *out)
{
    if (at + 8 > end) return false;
    uint64_t size = box_number(file, at, 4), head = 8;
    if (size == 1) {
        size = box_number(file, at + 8, 8);
        head = 16;
    }
    if (size == 0) size = end - at;
    if (size < head || size > end - at) return false;
    *out = (box){at + head, at + size};
    return true;
}

/* Finds a box; its name follows four bytes of size in every variant. */
bool box_find(FILE *file, box in, const char name[4], box *out)
{
    uint64_t at = in.at;
    for (int i = 0; i < BOX_MOST_STEPS && read_box(file, at, in.end, out); i++) {
        if (box_name_is(file, at + 4, name)) return true;
        at = out->end;
    }
    return false;
}

/* Reads the colour property with this number, counted from 1, if it is stated by code points. */
static bool read_property(FILE *file, box properties, uint64_t place, int numbers[3])
{
    uint64_t at = properties.at;
    box one;
    for (uint64_t i = 1; i < place; i++) {
        if (!read_box(file, at, properties.end, &one)) return false;
        at = one.end;
    }
    if (!read_box(file, at, properties.end, &one) || !box_name_is(file, at + 4, "colr") ||
        !box_name_is(file, one.at, "nclx"))
        return false;
    for (uint64_t k = 0; k < 3; k++)
        numbers[k] = (int)box_number(file, one.at + 4 + 2 * k, 2);
    return true;
}

/* Searches the table that associates items with properties. */
static bool find_colour(FILE *file, box table, box properties, uint64_t item, int numbers[3])
{
    enum { MOST_PLACES = 512 };
    int bytes = box_number(file, table.at, 1) ? 4 : 2, wide = box_number(file, table.at + 3, 1) & 1 ? 2 : 1;
    uint64_t items = box_number(file, table.at + 4, 4), at = table.at + 8;
    for (uint64_t i = 0; i < items && i < BOX_MOST_STEPS && at < table.end; i++) {
        bool meant = box_number(file, at, bytes) == item;
        uint64_t count = box_number(file, at + (uint64_t)bytes, 1);
        at += (uint64_t)bytes + 1;
        for (uint64_t k = 0; meant && k < count; k++) {
            uint64_t place = box_number(file, at + k * (uint64_t)wide, wide) & (wide == 2 ? 0x7fff : 0x7f);
            if (place && place < MOST_PLACES && read_property(file, properties, place, numbers)) return true;
        }
        if (meant) return false;
        at += count * (uint64_t)wide;
    }
    return false;
}

bool box_read_colour(FILE *file, int numbers[3])
{
    box meta, meant, all, properties, table;
    if (!box_find(file, (box){0, INT64_MAX}, "meta", &meta)) return false;
    meta.at += 4;
    if (!box_find(file, meta, "pitm", &meant) || !box_find(file, meta, "iprp", &all)) return false;
    uint64_t item = box_number(file, meant.at + 4, box_number(file, meant.at, 1) ? 4 : 2);
    return box_find(file, all, "ipco", &properties) && box_find(file, all, "ipma", &table) &&
           find_colour(file, table, properties, item, numbers);
}
