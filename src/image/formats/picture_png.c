/* SPDX-License-Identifier: MIT */
#include <errno.h>
#include <math.h>
#include <png.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "image/formats/picture.h"
#include "image/formats/picture_rows.h"
#include "image/metadata/exif.h"
#include "image/metadata/exif_text.h"

/* Facts from a PNG's chunks, wherever they are: some programs write the orientation after the pixels (ImageMagick). */
typedef struct chunks {
    bool has_cicp;
    unsigned char cicp[4]; /* primaries, transfer, matrix, full range */
    int orientation;
    int frames;      /* frames of an animation */
    bool overfull;   /* a chunk beside the pixels claims more bytes than the file has */
    uint64_t packed; /* bytes of all pixel chunks */
} chunks;

/* A file being read; libpng reports errors by longjmp, so that what must be freed is kept here. */
typedef struct reader {
    FILE *file;
    png_structp png;
    png_infop info;
    picture_layout layout;
    chunks chunks;
    bool profile, interlaced;
    size_t packed_row; /* bytes of a row as in the file, before pixels of less than a byte and palettes are expanded */
    uint8_t *codes;    /* codes of a row, or of all rows if they are interlaced */
    png_bytep *rows;
    picture_rows *to;
    char words[128];
    bool lacked; /* memory, when it left */
} reader;

static void leave(png_structp png, png_const_charp words)
{
    reader *r = png_get_error_ptr(png);
    snprintf(r->words, sizeof r->words, "%s", words);
    r->lacked = status_by_errno(OK) == MERLIN_NO_MEMORY;
    png_longjmp(png, 1);
}

static void say_nothing(png_structp png, png_const_charp words)
{
    (void)png;
    (void)words;
}

static void reader_free(reader *r)
{
    picture_rows_free(r->to);
    free(r->rows);
    free(r->codes);
    png_destroy_read_struct(&r->png, &r->info, NULL);
    if (r->file) fclose(r->file);
}

static status lack(const char *path)
{
    return fail(MERLIN_NO_MEMORY, "no memory to read %s", path);
}

static status reader_open(reader *r, const char *path)
{
    *r = (reader){.file = file_open(path)};
    if (!r->file) return fail_by_errno(MERLIN_BAD_INPUT, "cannot read %s", path);
    r->png = png_create_read_struct(PNG_LIBPNG_VER_STRING, r, leave, say_nothing);
    r->info = r->png ? png_create_info_struct(r->png) : NULL;
    return r->info ? OK : lack(path);
}

/* Finds the orientation in EXIF stored as text (exif_text.h); 0 for other texts. */
static status find_in_text(byte_source *file, uint64_t at, uint32_t size, bool packed, int *orientation)
{
    void *exif;
    size_t exif_size;
    exif_facts facts = {.orientation = 0};
    status s = exif_text_decode_at(file, at, size, packed, &exif, &exif_size);
    if (s == OK && exif) exif_parse(exif, exif_size, &facts);
    free(exif);
    *orientation = facts.orientation;
    return s;
}

/* Returns the orientation in an EXIF chunk; damage in it is ignored. */
static int orientation_in(const byte_source *file, uint64_t at, uint32_t size)
{
    enum { LARGEST = 1 << 16 }; /* as JPEG limits it */
    exif_facts facts = {.orientation = 1};
    if (size <= LARGEST) exif_parse_part(file, at, size, &facts);
    return facts.orientation;
}

static int frames_in(byte_source *file, uint64_t at)
{
    unsigned char b[4];
    bool there = byte_source_read(file, at, b, sizeof b) == sizeof b && b[0] == 0;
    return there ? b[1] << 16 | b[2] << 8 | b[3] : 0;
}

/* Reads what a chunk says whose content is at a position; by_text: the orientation in texts, 0 before there is any. */
static status take_chunk(byte_source *file, const char name[4], uint64_t at, uint32_t size, chunks *found, int *by_text)
{
    const bool pixels = memcmp(name, "IDAT", 4) == 0, packed = memcmp(name, "zTXt", 4) == 0;
    if (memcmp(name, "cICP", 4) == 0 && size == 4) found->has_cicp = byte_source_read(file, at, found->cicp, 4) == 4;
    if (memcmp(name, "eXIf", 4) == 0) found->orientation = orientation_in(file, at, size);
    if (memcmp(name, "acTL", 4) == 0 && size == 8) found->frames = frames_in(file, at);
    if (pixels) found->packed += size;
    found->overfull |= !pixels && (at > file->size || size > file->size - at);
    return *by_text == 0 && (packed || memcmp(name, "tEXt", 4) == 0) ? find_in_text(file, at, size, packed, by_text)
                                                                     : OK;
}

/* Walks over a file's chunks; damage is left for libpng to report. */
static status find_chunks(int descriptor, chunks *found)
{
    byte_source file;
    int by_text = 0;
    unsigned char head[8];
    status s = OK;
    *found = (chunks){.orientation = 0};
    byte_source_of_file(&file, descriptor);
    for (uint64_t at = 8; s == OK && byte_source_read(&file, at, head, sizeof head) == sizeof head;) {
        uint32_t size = (uint32_t)head[0] << 24 | (uint32_t)head[1] << 16 | (uint32_t)head[2] << 8 | head[3];
        if (memcmp(head + 4, "IEND", 4) == 0) break;
        s = take_chunk(&file, (const char *)head + 4, at + 8, size, found, &by_text);
        at += 12 + (uint64_t)size;
    }
    if (found->orientation == 0) found->orientation = by_text ? by_text : 1;
    return s;
}

/* Returns the light for a gAMA chunk. Near the gamma of screens the curve is sRGB's, which is no power (as the PNG
 * specification has it), unless the primaries differ; ImageMagick stores linear pictures as PNGs of gamma 1. */
static picture_light light_of_gamma(const reader *r)
{
    picture_light light = {.said = png_get_valid(r->png, r->info, PNG_INFO_sRGB) != 0};
    double gamma = 0, xy[8];
    if (light.said) return light;
    bool known = png_get_gAMA(r->png, r->info, &gamma) && gamma >= 0.1 && gamma <= 10;
    if (png_get_cHRM(r->png, r->info, xy + 6, xy + 7, xy, xy + 1, xy + 2, xy + 3, xy + 4, xy + 5)) {
        float rounded[8];
        for (int i = 0; i < 8; i++)
            rounded[i] = (float)xy[i];
        picture_light_set_primaries(rounded, &light);
    }
    light.said = known;
    bool screen = fabs(gamma * 2.2 - 1) < 0.05 && !light.has_primaries;
    if (!known || screen) return light;
    light.curve = PICTURE_CURVE_POWER;
    light.exponent = (float)(1 / gamma);
    return light;
}

/* Finds the meaning of the codes: by cICP, else by a profile, which is left to others, else by sRGB, gAMA and cHRM. */
static status find_light(reader *r, const char *path)
{
    const unsigned char *cicp = r->chunks.cicp;
    int primaries = cicp[0], transfer = cicp[1], matrix = cicp[2], full = cicp[3];
    r->profile = png_get_valid(r->png, r->info, PNG_INFO_iCCP) != 0;
    if (!r->chunks.has_cicp) {
        r->layout.light = light_of_gamma(r);
        return OK;
    }
    if (matrix != 0 || !picture_light_of_cicp(primaries, transfer, &r->layout.light))
        return fail(
            MERLIN_BAD_INPUT,
            "cannot read %s: its cICP chunk states primaries %d, transfer %d and matrix %d, which are not known "
            "here; save it as sRGB",
            path, primaries, transfer, matrix);
    r->layout.light.narrow = !full;
    r->profile &= !r->layout.light.said;
    return OK;
}

static bool read_head(reader *r)
{
    if (setjmp(png_jmpbuf(r->png))) return false;
    png_init_io(r->png, r->file);
    png_set_user_limits(r->png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_read_info(r->png, r->info);
    r->layout.width = (int)png_get_image_width(r->png, r->info);
    r->layout.height = (int)png_get_image_height(r->png, r->info);
    r->packed_row = png_get_rowbytes(r->png, r->info);
    r->interlaced = png_get_interlace_type(r->png, r->info) != PNG_INTERLACE_NONE;
    r->layout.sample = png_get_bit_depth(r->png, r->info) == 16 ? PICTURE_UINT16 : PICTURE_UINT8;
    return true;
}

/* Converts every variant to grey or RGB, with or without alpha, of 8 or 16 bits, and allocates a row. Returns false
 * without memory. */
static bool begin_rows(reader *r)
{
    if (setjmp(png_jmpbuf(r->png))) return false;
    png_set_expand(r->png);
    png_set_swap(r->png); /* 16-bit samples are big endian in the file */
    (void)png_set_interlace_handling(r->png);
    png_read_update_info(r->png, r->info);
    r->layout.bands = png_get_channels(r->png, r->info);
    r->layout.alpha = r->layout.bands % 2 == 0;
    return true;
}

static bool read_row(reader *r)
{
    if (setjmp(png_jmpbuf(r->png))) return false;
    png_read_row(r->png, r->codes, NULL);
    return true;
}

static bool read_all_rows(reader *r)
{
    if (setjmp(png_jmpbuf(r->png))) return false;
    png_read_image(r->png, r->rows);
    return true;
}

static status damaged(const reader *r, const char *path)
{
    return r->lacked ? lack(path)
                     : fail(MERLIN_BAD_INPUT, "cannot read %s: it is damaged or cut short (%s)", path, r->words);
}

static size_t line_bytes(const reader *r)
{
    return (size_t)r->layout.width * (size_t)r->layout.bands * (r->layout.sample == PICTURE_UINT16 ? 2 : 1);
}

static status make_codes(reader *r, const char *path)
{
    size_t height = r->interlaced ? (size_t)r->layout.height : 1;
    r->codes = malloc(line_bytes(r) * height);
    r->rows = malloc(height * sizeof *r->rows);
    if (!r->codes || !r->rows) return lack(path);
    for (size_t y = 0; y < height; y++)
        r->rows[y] = r->codes + y * line_bytes(r);
    return OK;
}

static status read_rows(reader *r, const char *path)
{
    if (r->interlaced && !read_all_rows(r)) return damaged(r, path);
    for (int y = 0; y < r->layout.height; y++) {
        if (!r->interlaced && !read_row(r)) return damaged(r, path);
        picture_rows_put(r->to, y, r->interlaced ? r->rows[y] : r->codes);
    }
    return OK;
}

/* Tells whether the file has enough bytes: PNG's compression has a maximum ratio, and a claim beyond it costs memory
 * and time for nothing. */
static bool is_long_enough(const reader *r)
{
    const double most = 1032;
    return (double)r->packed_row * r->layout.height <= most * ((double)r->chunks.packed + 64);
}

static status check_budget(const reader *r, const char *path)
{
    const picture_layout *l = &r->layout;
    status s = picture_check_size(path, l->width, l->height);
    if (s != OK || !r->interlaced) return s;
    return picture_check_whole(path, l->width, l->height, l->sample == PICTURE_UINT16 ? 8 : 4, "without interlacing");
}

static status read_open(reader *r, const char *path, picture_colour how, img *color, img *alpha)
{
    status s = find_chunks(fileno(r->file), &r->chunks);
    if (s != OK) return s;
    errno = 0; /* tells lack of memory from damage (leave) */
    if (r->chunks.overfull) return fail(MERLIN_BAD_INPUT, "cannot read %s: it is damaged or cut short", path);
    if (!read_head(r)) return damaged(r, path);
    s = check_budget(r, path);
    if (s == OK) s = find_light(r, path);
    if (s != OK || r->profile || !color) return s;
    r->layout.orientation = r->chunks.orientation;
    if (!begin_rows(r)) return damaged(r, path);
    if (!is_long_enough(r)) return fail(MERLIN_BAD_INPUT, "cannot read %s: it is damaged or cut short", path);
    s = make_codes(r, path);
    if (s == OK) s = picture_rows_new(&r->layout, how, color, alpha, &r->to);
    return s == OK ? read_rows(r, path) : s;
}

status picture_read_png(const char *path, picture_colour how, img *color, img *alpha, picture_head *head)
{
    reader r;
    status s = reader_open(&r, path);
    if (s == OK) s = read_open(&r, path, how, color, alpha);
    *head = (picture_head){.width = r.layout.width,
                           .height = r.layout.height,
                           .bits = r.layout.sample == PICTURE_UINT16 ? 16 : 8,
                           .frames = r.chunks.frames,
                           .plain = !r.profile,
                           .light = r.layout.light};
    reader_free(&r);
    return s;
}
