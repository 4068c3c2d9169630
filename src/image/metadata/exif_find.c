/* SPDX-License-Identifier: MIT */
/* Finds where each kind of file keeps its EXIF. Sizes and positions are trusted within the file's length: each step
 * advances by at least a box or chunk header, and the number of steps is limited. */
#include "image/metadata/exif_find.h"

#include <string.h>

#include "image/metadata/box_file.h"

enum { MOST_STEPS = BOX_MOST_STEPS, MOST_SIZE = 1 << 20, HEAD_BYTES = 16 };

/* Reads a little-endian number of so many bytes at a position; 0 at the file's end. */
static uint64_t little_number(byte_source *from, uint64_t at, int bytes)
{
    unsigned char b[8];
    uint64_t number = 0;
    if (byte_source_read(from, at, b, (size_t)bytes) != (size_t)bytes) return 0;
    for (int i = 0; i < bytes; i++)
        number = number << 8 | b[bytes - 1 - i];
    return number;
}

static bool is_place(uint64_t at, uint64_t size, exif_place *out)
{
    *out = (exif_place){at, size <= MOST_SIZE ? (size_t)size : 0};
    return out->size > 0;
}

/* Walks over the markers before the pixels. */
static bool find_in_jpeg(byte_source *from, uint64_t start, exif_place *out)
{
    enum { APP1 = 0xffe1, START_OF_SCAN = 0xffda, END = 0xffd9 };
    uint64_t at = start + 2;
    for (int i = 0; i < MOST_STEPS; i++) {
        uint64_t marker = box_number(from, at, 2), length = box_number(from, at + 2, 2);
        if (marker < 0xff01 || marker == START_OF_SCAN || marker == END || length < 2) return false;
        if (marker == APP1 && box_name_is(from, at + 4, "Exif")) return is_place(at + 4, length - 2, out);
        at += 2 + length;
    }
    return false;
}

static bool find_in_png(byte_source *from, exif_place *out)
{
    uint64_t at = 8;
    for (int i = 0; i < MOST_STEPS; i++) {
        uint64_t length = box_number(from, at, 4);
        if (box_name_is(from, at + 4, "eXIf")) return is_place(at + 8, length, out);
        if (length > INT32_MAX || box_name_is(from, at + 4, "IEND")) return false;
        at += 12 + length;
    }
    return false;
}

static bool find_in_webp(byte_source *from, exif_place *out)
{
    uint64_t at = 12;
    for (int i = 0; i < MOST_STEPS; i++) {
        uint64_t length = little_number(from, at + 4, 4);
        if (box_name_is(from, at, "EXIF")) return is_place(at + 8, length, out);
        if (box_number(from, at, 4) == 0) return false;
        at += 8 + length + (length & 1);
    }
    return false;
}

/* ---- HEIC and AVIF: nested boxes ---- */

/* Returns the number of the item that is EXIF, by the table of items; 0 if there is none. */
static uint64_t exif_item(byte_source *from, media_box table)
{
    uint64_t version = box_number(from, table.at, 1), counter = version == 0 ? 2 : 4;
    media_box rest = {table.at + 4 + counter, table.end}, entry;
    for (int i = 0; i < MOST_STEPS && box_find(from, rest, "infe", &entry); i++) {
        version = box_number(from, entry.at, 1);
        int bytes = version == 2 ? 2 : 4;
        if (version >= 2 && box_name_is(from, entry.at + 4 + (uint64_t)bytes + 2, "Exif"))
            return box_number(from, entry.at + 4, bytes);
        rest.at = entry.end;
    }
    return 0;
}

/* Finds an item's only extent, from the file's start. */
static bool find_item(byte_source *from, media_box table, uint64_t item, exif_place *out)
{
    uint64_t version = box_number(from, table.at, 1), sizes = box_number(from, table.at + 4, 2);
    int offset = sizes >> 12 & 15, length = sizes >> 8 & 15, base = sizes >> 4 & 15, index = version ? sizes & 15 : 0;
    int number = version < 2 ? 2 : 4;
    uint64_t at = table.at + 6, items = box_number(from, at, number);
    if (offset > 8 || length > 8 || base > 8 || index > 8) return false;
    at += (uint64_t)number;
    for (uint64_t i = 0; i < items && i < MOST_STEPS && at < table.end; i++) {
        uint64_t name = box_number(from, at, number);
        at += (uint64_t)number;
        uint64_t way = version ? box_number(from, at, 2) & 15 : 0;
        at += (version ? 2 : 0) + 2;
        uint64_t start = box_number(from, at, base), extents = box_number(from, at + (uint64_t)base, 2);
        at += (uint64_t)base + 2;
        uint64_t first = at + (uint64_t)index;
        if (name == item)
            return way == 0 && extents == 1 &&
                   is_place(start + box_number(from, first, offset), box_number(from, first + (uint64_t)offset, length),
                            out);
        at += extents * (uint64_t)(index + offset + length);
    }
    return false;
}

/* Finds the EXIF item, which begins with the offset of its TIFF header. */
static bool find_in_heif(byte_source *from, exif_place *out)
{
    media_box all = {0, INT64_MAX}, meta, table;
    if (!box_find(from, all, "meta", &meta)) return false;
    media_box inside = {meta.at + 4, meta.end};
    uint64_t item = box_find(from, inside, "iinf", &table) ? exif_item(from, table) : 0;
    if (!item || !box_find(from, inside, "iloc", &table) || !find_item(from, table, item, out)) return false;
    uint64_t skip = 4 + box_number(from, out->at, 4);
    return skip < out->size && is_place(out->at + skip, out->size - skip, out);
}

/* Finds the EXIF page of Canon's CR3, which is alone in a box of the first one's private box. */
static bool find_in_cr3(byte_source *from, exif_place *out)
{
    enum { NAME_OF_PRIVATE = 16 };
    media_box all = {0, INT64_MAX}, movie, private, page;
    if (!box_find(from, all, "moov", &movie) || !box_find(from, movie, "uuid", &private)) return false;
    private.at += NAME_OF_PRIVATE;
    return box_find(from, private, "CMT2", &page) && is_place(page.at, page.end - page.at, out);
}

bool exif_find(byte_source *from, exif_place *out)
{
    char head[HEAD_BYTES] = {0};
    *out = (exif_place){0};
    if (byte_source_read(from, 0, head, sizeof head) < 12) return false;
    if (memcmp(head, "\xff\xd8\xff", 3) == 0) return find_in_jpeg(from, 0, out);
    if (memcmp(head, "\x89PNG", 4) == 0) return find_in_png(from, out);
    if (memcmp(head, "RIFF", 4) == 0 && memcmp(head + 8, "WEBP", 4) == 0) return find_in_webp(from, out);
    if (memcmp(head + 4, "ftypcrx ", 8) == 0) return find_in_cr3(from, out);
    if (memcmp(head + 4, "ftyp", 4) == 0) return find_in_heif(from, out);
    if (memcmp(head, "FUJIFILM", 8) == 0) return find_in_jpeg(from, box_number(from, 84, 4), out);
    return memcmp(head, "II", 2) == 0 || memcmp(head, "MM", 2) == 0;
}
