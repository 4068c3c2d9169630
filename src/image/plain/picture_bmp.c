/* SPDX-License-Identifier: MIT */
/* BMP, as Microsoft documents BITMAPFILEHEADER and the headers after it (core, info, version 4 and 5), and OS/2's
 * longer ones, whose first 40 bytes are the same: with a palette, run-length coded or not, or with bit masks. */
#include <stdlib.h>
#include <string.h>

#include "image/plain/plain_file.h"

enum { FILE_HEAD = 14, CORE = 12, INFO = 40, V3 = 56, OS2 = 64, MOST_HEAD = 124 };
enum { RGB = 0, RLE8 = 1, RLE4 = 2, BITFIELDS = 3, ALPHA_BITFIELDS = 6 };

typedef struct field {
    uint32_t mask;
    int shift, bits;
} field;

typedef struct bmp {
    int bits, packing;
    bool masked;     /* pixels are read by `fields` */
    field fields[4]; /* red, green, blue, alpha */
    uint8_t palette[256][3];
    unsigned colours;
    uint8_t *bytes; /* a row in the file; of runs its indices, one a byte */
    size_t row_bytes;
    long long blank; /* rows that runs skipped */
    int start;       /* column at which the row after them begins */
    bool ended;
} bmp;

static field field_of(uint32_t mask)
{
    field f = {.mask = mask};
    for (; mask && !(mask & 1); mask >>= 1)
        f.shift++;
    for (; mask; mask >>= 1)
        f.bits++;
    return f;
}

/* Returns a field's value scaled to 16 bits. */
static uint16_t value_of(const field *f, uint32_t pixel)
{
    const uint64_t most = (1ULL << f->bits) - 1;
    return f->bits ? (uint16_t)(((uint64_t)((pixel & f->mask) >> f->shift) * UINT16_MAX + most / 2) / most) : 0;
}

/* Reads the bit masks, which follow a header of 40 bytes and are inside longer ones. */
static void set_fields(bmp *b, const uint8_t *head, unsigned length)
{
    static const uint32_t plain16[4] = {0x7c00, 0x3e0, 0x1f, 0}, plain32[4] = {0xff0000, 0xff00, 0xff, 0};
    b->masked = b->bits == 16 || b->bits == 32;
    bool said = b->packing == BITFIELDS || b->packing == ALPHA_BITFIELDS;
    bool alpha = b->packing == ALPHA_BITFIELDS || length >= V3;
    for (int i = 0; i < 4; i++) {
        uint32_t mask = b->bits == 16 ? plain16[i] : plain32[i];
        if (said) mask = i == 3 && !alpha ? 0 : plain_little32(head + INFO + 4 * i);
        if (b->bits == 16) mask &= UINT16_MAX;
        b->fields[i] = field_of(mask);
    }
}

static bool is_known(const bmp *b, unsigned length)
{
    switch (b->packing) {
    case RGB:
        return b->bits == 1 || b->bits == 2 || b->bits == 4 || b->bits == 8 || b->bits == 16 || b->bits == 24 ||
               b->bits == 32;
    case RLE8:
        return b->bits == 8;
    case RLE4:
        return b->bits == 4;
    default:
        return (b->packing == BITFIELDS || b->packing == ALPHA_BITFIELDS) && (b->bits == 16 || b->bits == 32) &&
               length >= INFO && length != OS2;
    }
}

static status refuse(const plain_file *f, const bmp *b)
{
    return fail(MERLIN_BAD_INPUT,
                "cannot read %s: a BMP of %d bits a pixel and compression %d is not read here; save it as PNG", f->path,
                b->bits, b->packing);
}

/* Reads the palette: entries of 3 (core) or 4 bytes, blue first, as many as fit before the pixels. */
static bool read_palette(plain_file *f, bmp *b, long at, long pixels, unsigned claimed, size_t entry)
{
    unsigned most = b->bits <= 8 ? 1U << b->bits : 0;
    b->colours = claimed && claimed < most ? claimed : most;
    if (pixels >= at && (size_t)(pixels - at) / entry < b->colours)
        b->colours = (unsigned)((size_t)(pixels - at) / entry);
    if (fseeko(f->file, at, SEEK_SET) != 0) return false;
    for (unsigned i = 0; i < b->colours; i++) {
        uint8_t bytes[4];
        if (!plain_get(f, bytes, entry)) return false;
        for (int c = 0; c < 3; c++)
            b->palette[i][c] = bytes[2 - c];
    }
    return true;
}

static void set_layout(plain_file *f, const bmp *b)
{
    bool deep = false;
    for (int i = 0; b->masked && i < 4; i++)
        deep |= b->fields[i].bits > 8;
    f->layout.alpha = b->masked && b->fields[3].mask;
    f->layout.bands = f->layout.alpha ? 4 : 3;
    f->layout.sample = deep ? PICTURE_UINT16 : PICTURE_UINT8;
    f->bits = 8; /* at most 8 bits, as the format is for screens */
}

/* Reads width, height, bits and compression from a header of this length. */
static void take_size(plain_file *f, bmp *b, const uint8_t *head, unsigned length)
{
    bool core = length == CORE;
    int64_t height = core ? (int32_t)plain_little16(head + 6) : (int32_t)plain_little32(head + 8);
    int32_t width = core ? (int32_t)plain_little16(head + 4) : (int32_t)plain_little32(head + 4);
    b->bits = (int)plain_little16(head + (core ? 10 : 14));
    b->packing = core || length < 20 ? RGB : (int)(plain_little32(head + 16) & INT32_MAX);
    f->layout.orientation = height < 0 ? 1 : 4;
    if (height < 0) height = -height;
    f->layout.width = width;
    f->layout.height = height <= INT32_MAX ? (int)height : 0;
}

static bool is_packed(const bmp *b)
{
    return b->packing == RLE8 || b->packing == RLE4;
}

static status make_row(plain_file *f, bmp *b)
{
    const double most_of_a_byte = 1024; /* largest number of pixels of a byte of run-length codes */
    size_t width = (size_t)(f->layout.width > 0 ? f->layout.width : 0);
    b->row_bytes = is_packed(b) ? width : (width * (size_t)b->bits + 31) / 32 * 4;
    double pixels = (double)width * f->layout.height;
    status s = plain_check(f, is_packed(b) ? pixels / most_of_a_byte : pixels * b->bits / 8);
    if (s != OK) return s;
    if (b->row_bytes == 0) return plain_damaged(f);
    b->bytes = malloc(b->row_bytes);
    return b->bytes ? OK : fail(MERLIN_NO_MEMORY, "no memory to read %s", f->path);
}

static status read_head(plain_file *f, bmp *b)
{
    uint8_t head[FILE_HEAD + MOST_HEAD + 16] = {0}, *info = head + FILE_HEAD;
    size_t got = fread(head, 1, sizeof head, f->file);
    unsigned length = plain_little32(info), pixels = plain_little32(head + 10);
    if (got < FILE_HEAD + CORE || length > MOST_HEAD || got < FILE_HEAD + length) return plain_damaged(f);
    memset(info + length + 16, 0, sizeof head - FILE_HEAD - length - 16);
    take_size(f, b, info, length);
    if (!is_known(b, length)) return refuse(f, b);
    set_fields(b, info, length);
    set_layout(f, b);
    unsigned behind = length == INFO && b->packing == BITFIELDS         ? 12
                      : length == INFO && b->packing == ALPHA_BITFIELDS ? 16
                                                                        : 0;
    long palette = FILE_HEAD + (long)length + (long)behind;
    unsigned claimed = length >= 36 ? plain_little32(info + 32) : 0;
    size_t entry = length == CORE ? 3 : 4;
    if (!read_palette(f, b, palette, (long)pixels, claimed, entry)) return plain_damaged(f);
    if (pixels && fseeko(f->file, (off_t)pixels, SEEK_SET) != 0) return plain_damaged(f);
    return make_row(f, b);
}

static status bmp_open(plain_file *f, void **state)
{
    bmp *b = calloc(1, sizeof *b);
    *state = b;
    return b ? read_head(f, b) : fail(MERLIN_NO_MEMORY, "no memory to read %s", f->path);
}

/* Stores an index in the current row; some writers' runs extend beyond its end. */
static void put_index(const plain_file *f, bmp *b, int *x, unsigned index)
{
    if (*x < f->layout.width) b->bytes[(*x)++] = (uint8_t)index;
}

/* Stores a run of one index or, for 4 bits, two alternating ones. */
static void put_run(const plain_file *f, bmp *b, int *x, int count, unsigned code)
{
    for (int i = 0; i < count; i++)
        put_index(f, b, x, b->packing == RLE8 ? code : i % 2 ? code & 15 : code >> 4);
}

/* Stores literal indices, which are padded to pairs of bytes. */
static bool put_literal(plain_file *f, bmp *b, int *x, int count)
{
    int bytes = b->packing == RLE8 ? count : (count + 1) / 2;
    uint8_t codes[256];
    if (!plain_get(f, codes, (size_t)bytes + (size_t)(bytes % 2))) return false;
    for (int i = 0; i < count; i++)
        put_index(f, b, x, b->packing == RLE8 ? codes[i] : i % 2 ? codes[i / 2] & 15U : codes[i / 2] >> 4);
    return true;
}

/* Moves right and down from the current position. */
static bool step(plain_file *f, bmp *b, int *x, bool *row_ends)
{
    uint8_t by[2];
    if (!plain_get(f, by, 2)) return false;
    *x = *x + by[0] < f->layout.width ? *x + by[0] : f->layout.width;
    *row_ends = by[1] > 0;
    if (!*row_ends) return true;
    b->blank = by[1] - 1;
    b->start = *x;
    return true;
}

/* Decodes a row of runs; skipped pixels have the first colour. */
static bool unpack_row(plain_file *f, bmp *b)
{
    memset(b->bytes, 0, b->row_bytes);
    if (b->ended || b->blank-- > 0) return true;
    b->blank = 0;
    int x = b->start;
    b->start = 0;
    for (bool row_ends = false; !row_ends;) {
        int count = getc(f->file), code = getc(f->file);
        if (code == EOF) return false;
        if (count > 0)
            put_run(f, b, &x, count, (unsigned)code);
        else if (code == 2 ? !step(f, b, &x, &row_ends) : code > 2 && !put_literal(f, b, &x, code))
            return false;
        b->ended = count == 0 && code == 1;
        row_ends |= count == 0 && code < 2;
    }
    return true;
}

static unsigned index_at(const bmp *b, int x)
{
    if (is_packed(b) || b->bits == 8) return b->bytes[x];
    int at = x * b->bits, shift = 8 - b->bits - at % 8;
    return b->bytes[at / 8] >> shift & ((1U << b->bits) - 1);
}

static void put_fields(const plain_file *f, const bmp *b, void *samples)
{
    size_t bands = (size_t)f->layout.bands;
    for (size_t x = 0; x < (size_t)f->layout.width; x++) {
        uint32_t pixel = b->bits == 16 ? plain_little16(b->bytes + 2 * x) : plain_little32(b->bytes + 4 * x);
        for (size_t c = 0; c < bands; c++) {
            uint16_t value = value_of(&b->fields[c], pixel);
            if (f->layout.sample == PICTURE_UINT16)
                ((uint16_t *)samples)[x * bands + c] = value;
            else
                ((uint8_t *)samples)[x * bands + c] = (uint8_t)((value + 128) / 257);
        }
    }
}

/* Converts colours of palettes and of 24 bits; an index beyond the palette is black, as in other readers. */
static void put_colours(const plain_file *f, const bmp *b, uint8_t *to)
{
    static const uint8_t black[3];
    for (int x = 0; x < f->layout.width; x++, to += 3) {
        unsigned index = b->bits <= 8 ? index_at(b, x) : 0;
        for (int c = 0; c < 3; c++)
            to[c] = b->bits == 24 ? b->bytes[3 * x + 2 - c] : index < b->colours ? b->palette[index][c] : black[c];
    }
}

/* Reads a row; the last one may lack its padding to four bytes. */
static bool read_row(plain_file *f, bmp *b)
{
    size_t needed = ((size_t)f->layout.width * (size_t)b->bits + 7) / 8;
    return fread(b->bytes, 1, b->row_bytes, f->file) >= needed;
}

static bool bmp_row(plain_file *f, void *state, void *samples)
{
    bmp *b = state;
    if (!(is_packed(b) ? unpack_row(f, b) : read_row(f, b))) return false;
    if (b->masked)
        put_fields(f, b, samples);
    else
        put_colours(f, b, samples);
    return true;
}

static void bmp_close(void *state)
{
    bmp *b = state;
    if (b) free(b->bytes);
    free(b);
}

const plain_format plain_bmp = {bmp_open, bmp_row, bmp_close};
