/* SPDX-License-Identifier: MIT */
#include "image/metadata/tiff_head.h"

#include <string.h>

enum {
    BYTE = 1,
    ASCII = 2,
    SHORT = 3,
    LONG = 4,
    RATIONAL = 5,
    UNDEFINED = 7,
    SIGNED_RATIONAL = 10,
    FLOAT = 11,
    DOUBLE = 12
};
enum { FOLDER = 13, BIG_TIFF = 43 };

/* Reads a number of so many bytes at a position; 0 beyond the end. */
static uint64_t number_at(const tiff_head *t, uint64_t at, int bytes)
{
    unsigned char b[8];
    uint64_t number = 0;
    if (byte_source_read(t->from, at, b, (size_t)bytes) != (size_t)bytes) return 0;
    for (int i = 0; i < bytes; i++)
        number = number << 8 | b[t->big_endian ? i : bytes - 1 - i];
    return number;
}

static int entry_bytes(const tiff_head *t)
{
    return t->wide ? 20 : 12;
}

static int offset_bytes(const tiff_head *t)
{
    return t->wide ? 8 : 4;
}

/* Returns a page's number of entries, limited, as damaged pages claim more than any has. */
static uint64_t entries_of(const tiff_head *t, uint64_t page)
{
    enum { MOST = 4096 };
    uint64_t entries = number_at(t, page, t->wide ? 8 : 2);
    return entries < MOST ? entries : MOST;
}

/* Returns the position of an entry; 0 if the page does not have it. */
static uint64_t find_entry(const tiff_head *t, uint64_t page, unsigned tag)
{
    uint64_t first = page + (t->wide ? 8 : 2), entries = page ? entries_of(t, page) : 0;
    for (uint64_t i = 0; i < entries; i++) {
        uint64_t at = first + i * (uint64_t)entry_bytes(t);
        if (number_at(t, at, 2) == tag) return at;
    }
    return 0;
}

static int bytes_of_type(uint64_t type)
{
    return type == BYTE || type == ASCII || type == UNDEFINED ? 1
           : type == SHORT                                    ? 2
           : type == LONG || type == FOLDER                   ? 4
                                                              : 0;
}

uint64_t tiff_count(const tiff_head *t, uint64_t page, unsigned tag)
{
    uint64_t at = find_entry(t, page, tag);
    return at ? number_at(t, at + 4, offset_bytes(t)) : 0;
}

uint32_t tiff_value_at(const tiff_head *t, uint64_t page, unsigned tag, uint64_t index)
{
    uint64_t at = find_entry(t, page, tag);
    int bytes = at ? bytes_of_type(number_at(t, at + 2, 2)) : 0;
    uint64_t count = bytes ? number_at(t, at + 4, offset_bytes(t)) : 0;
    if (index >= count) return 0;
    uint64_t value = at + 4 + (uint64_t)offset_bytes(t);
    if (count > (uint64_t)(offset_bytes(t) / bytes)) value = number_at(t, value, offset_bytes(t));
    return (uint32_t)number_at(t, value + index * (uint64_t)bytes, bytes);
}

uint32_t tiff_value(const tiff_head *t, uint64_t page, unsigned tag)
{
    return tiff_value_at(t, page, tag, 0);
}

bool tiff_open(tiff_head *t, byte_source *from)
{
    *t = (tiff_head){.from = from};
    uint64_t order = number_at(t, 0, 1);
    t->big_endian = order == 'M';
    t->wide = number_at(t, 2, 2) == BIG_TIFF;
    uint64_t page = number_at(t, t->wide ? 8 : 4, offset_bytes(t));
    for (; page && t->pages < TIFF_MOST_PAGES; t->pages++) {
        t->page[t->pages] = page;
        uint64_t behind = page + (t->wide ? 8 : 2) + entries_of(t, page) * (uint64_t)entry_bytes(t);
        page = number_at(t, behind, offset_bytes(t));
    }
    return (order == 'M' || order == 'I') && t->pages > 0;
}

/* Reads the number at a position by its TIFF type. */
static double real_of(const tiff_head *t, uint64_t at, uint64_t type)
{
    uint64_t bits = number_at(t, at, type == DOUBLE ? 8 : 4);
    uint32_t low = (uint32_t)bits;
    float narrow;
    double wide;
    memcpy(&narrow, &low, sizeof narrow);
    memcpy(&wide, &bits, sizeof wide);
    if (type == FLOAT || type == DOUBLE) return type == FLOAT ? (double)narrow : wide;
    bool negative = type == SIGNED_RATIONAL;
    uint32_t under = (uint32_t)number_at(t, at + 4, 4);
    double over = negative ? (double)(int32_t)low : (double)low, by = negative ? (double)(int32_t)under : (double)under;
    return under ? over / by : 0;
}

double tiff_real_at(const tiff_head *t, uint64_t page, unsigned tag, uint64_t index)
{
    uint64_t at = find_entry(t, page, tag), type = at ? number_at(t, at + 2, 2) : 0;
    if (type != RATIONAL && type != SIGNED_RATIONAL && type != FLOAT && type != DOUBLE)
        return tiff_value_at(t, page, tag, index);
    uint64_t bytes = type == FLOAT ? 4 : 8, count = number_at(t, at + 4, offset_bytes(t));
    if (index >= count) return 0;
    uint64_t value = at + 4 + (uint64_t)offset_bytes(t);
    if (count > (uint64_t)offset_bytes(t) / bytes) value = number_at(t, value, offset_bytes(t));
    return real_of(t, value + index * bytes, type);
}

double tiff_real(const tiff_head *t, uint64_t page, unsigned tag)
{
    return tiff_real_at(t, page, tag, 0);
}
