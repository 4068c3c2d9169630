/* Finds where files of the different kinds keep their EXIF. Sizes and places are believed as far as the file goes: each
 * walk moves on by a box at least, and takes so many steps at most. */
#include <string.h>

#include "image/exif.h"

enum { MOST_STEPS = 4096, MOST_SIZE = 1 << 20, HEAD_BYTES = 16 };

/* The big- or little-endian number in so many bytes at a place; 0 where the file has ended. */
static uint64_t number_at(FILE *file, uint64_t at, int bytes, bool big_endian)
{
    unsigned char b[8];
    uint64_t number = 0;
    if (at > INT64_MAX || fseeko(file, (off_t)at, SEEK_SET) != 0) return 0;
    if (fread(b, 1, (size_t)bytes, file) != (size_t)bytes) return 0;
    for (int i = 0; i < bytes; i++)
        number = number << 8 | b[big_endian ? i : bytes - 1 - i];
    return number;
}

static uint64_t big(FILE *file, uint64_t at, int bytes)
{
    return number_at(file, at, bytes, true);
}

static bool name_at(FILE *file, uint64_t at, const char name[4])
{
    char found[4];
    return at <= INT64_MAX && fseeko(file, (off_t)at, SEEK_SET) == 0 && fread(found, 1, 4, file) == 4 &&
           memcmp(found, name, 4) == 0;
}

static bool is_place(uint64_t at, uint64_t size, exif_place *out)
{
    *out = (exif_place){at, size <= MOST_SIZE ? (size_t)size : 0};
    return out->size > 0;
}

/* Markers up to the pixels. */
static bool find_in_jpeg(FILE *file, uint64_t start, exif_place *out)
{
    enum { APP1 = 0xffe1, START_OF_SCAN = 0xffda, END = 0xffd9 };
    uint64_t at = start + 2;
    for (int i = 0; i < MOST_STEPS; i++) {
        uint64_t marker = big(file, at, 2), length = big(file, at + 2, 2);
        if (marker < 0xff01 || marker == START_OF_SCAN || marker == END || length < 2) return false;
        if (marker == APP1 && name_at(file, at + 4, "Exif")) return is_place(at + 4, length - 2, out);
        at += 2 + length;
    }
    return false;
}

static bool find_in_png(FILE *file, exif_place *out)
{
    uint64_t at = 8;
    for (int i = 0; i < MOST_STEPS; i++) {
        uint64_t length = big(file, at, 4);
        if (name_at(file, at + 4, "eXIf")) return is_place(at + 8, length, out);
        if (length > INT32_MAX || name_at(file, at + 4, "IEND")) return false;
        at += 12 + length;
    }
    return false;
}

static bool find_in_webp(FILE *file, exif_place *out)
{
    uint64_t at = 12;
    for (int i = 0; i < MOST_STEPS; i++) {
        uint64_t length = number_at(file, at + 4, 4, false);
        if (name_at(file, at, "EXIF")) return is_place(at + 8, length, out);
        if (big(file, at, 4) == 0) return false;
        at += 8 + length + (length & 1);
    }
    return false;
}

/* ---- HEIC and AVIF: boxes in boxes ---- */

typedef struct box {
    uint64_t at, end; /* of what is in it */
} box;

/* The first box of a name among those in `in`. */
static bool find_box(FILE *file, box in, const char name[4], box *out)
{
    uint64_t at = in.at;
    for (int i = 0; i < MOST_STEPS && at + 8 <= in.end; i++) {
        uint64_t size = big(file, at, 4), head = 8;
        if (size == 1) {
            size = big(file, at + 8, 8);
            head = 16;
        }
        if (size == 0) size = in.end - at;
        if (size < head || size > in.end - at) return false;
        *out = (box){at + head, at + size};
        if (name_at(file, at + 4, name)) return true;
        at += size;
    }
    return false;
}

/* The number of the item that is EXIF, by the table of items; 0 if there is none. */
static uint64_t exif_item(FILE *file, box table)
{
    uint64_t version = big(file, table.at, 1), counter = version == 0 ? 2 : 4;
    box rest = {table.at + 4 + counter, table.end}, entry;
    for (int i = 0; i < MOST_STEPS && find_box(file, rest, "infe", &entry); i++) {
        version = big(file, entry.at, 1);
        int bytes = version == 2 ? 2 : 4;
        if (version >= 2 && name_at(file, entry.at + 4 + (uint64_t)bytes + 2, "Exif"))
            return big(file, entry.at + 4, bytes);
        rest.at = entry.end;
    }
    return 0;
}

/* An item's only extent, from the file's start. */
static bool find_item(FILE *file, box table, uint64_t item, exif_place *out)
{
    uint64_t version = big(file, table.at, 1), sizes = big(file, table.at + 4, 2);
    int offset = sizes >> 12 & 15, length = sizes >> 8 & 15, base = sizes >> 4 & 15, index = version ? sizes & 15 : 0;
    int number = version < 2 ? 2 : 4;
    uint64_t at = table.at + 6, items = big(file, at, number);
    if (offset > 8 || length > 8 || base > 8 || index > 8) return false;
    at += (uint64_t)number;
    for (uint64_t i = 0; i < items && i < MOST_STEPS && at < table.end; i++) {
        uint64_t name = big(file, at, number);
        at += (uint64_t)number;
        uint64_t way = version ? big(file, at, 2) & 15 : 0;
        at += (version ? 2 : 0) + 2;
        uint64_t start = big(file, at, base), extents = big(file, at + (uint64_t)base, 2);
        at += (uint64_t)base + 2;
        uint64_t first = at + (uint64_t)index;
        if (name == item)
            return way == 0 && extents == 1 &&
                   is_place(start + big(file, first, offset), big(file, first + (uint64_t)offset, length), out);
        at += extents * (uint64_t)(index + offset + length);
    }
    return false;
}

/* Finds the EXIF item, which begins with the distance to the TIFF's head. */
static bool find_in_heif(FILE *file, exif_place *out)
{
    box all = {0, INT64_MAX}, meta, table;
    if (!find_box(file, all, "meta", &meta)) return false;
    box inside = {meta.at + 4, meta.end};
    uint64_t item = find_box(file, inside, "iinf", &table) ? exif_item(file, table) : 0;
    if (!item || !find_box(file, inside, "iloc", &table) || !find_item(file, table, item, out)) return false;
    uint64_t skip = 4 + big(file, out->at, 4);
    return skip < out->size && is_place(out->at + skip, out->size - skip, out);
}

/* Canon's CR3: the EXIF page stands alone in a box of the first one's private box. */
static bool find_in_cr3(FILE *file, exif_place *out)
{
    enum { NAME_OF_PRIVATE = 16 };
    box all = {0, INT64_MAX}, movie, private, page;
    if (!find_box(file, all, "moov", &movie) || !find_box(file, movie, "uuid", &private)) return false;
    private.at += NAME_OF_PRIVATE;
    return find_box(file, private, "CMT2", &page) && is_place(page.at, page.end - page.at, out);
}

bool exif_find(FILE *file, exif_place *out)
{
    char head[HEAD_BYTES] = {0};
    *out = (exif_place){0};
    rewind(file);
    if (fread(head, 1, sizeof head, file) < 12) return false;
    if (memcmp(head, "\xff\xd8\xff", 3) == 0) return find_in_jpeg(file, 0, out);
    if (memcmp(head, "\x89PNG", 4) == 0) return find_in_png(file, out);
    if (memcmp(head, "RIFF", 4) == 0 && memcmp(head + 8, "WEBP", 4) == 0) return find_in_webp(file, out);
    if (memcmp(head + 4, "ftypcrx ", 8) == 0) return find_in_cr3(file, out);
    if (memcmp(head + 4, "ftyp", 4) == 0) return find_in_heif(file, out);
    if (memcmp(head, "FUJIFILM", 8) == 0) return find_in_jpeg(file, big(file, 84, 4), out);
    return memcmp(head, "II", 2) == 0 || memcmp(head, "MM", 2) == 0;
}
