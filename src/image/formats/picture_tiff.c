/* SPDX-License-Identifier: MIT */
/* Reads what a TIFF states and libvips ignores or does not find: which page is the picture, whether it is a camera's
 * raw file, and how much memory it would take. */
#include <stdint.h>
#include <string.h>

#include "image/formats/picture.h"
#include "image/metadata/picture_tiff_light.h"
#include "image/metadata/tiff_head.h"

enum { JPEG = 7, YCBCR = 6, CMYK = 5, MOSAIC = 32803, LINEAR_RAW = 34892, ASSOCIATED = 1, REDUCED = 1, MASK = 4 };
enum { MOST_BELOW = 8 }; /* most sub-pages of a page */

static bool is_raw_page(const tiff_head *t, uint64_t page)
{
    uint32_t meaning = tiff_value(t, page, TIFF_PHOTOMETRIC);
    return meaning == MOSAIC || meaning == LINEAR_RAW;
}

/* Tells whether "CR" and a version follow the header, where ordinary TIFFs may have pixels: Canon's CR2. */
static bool is_canon(byte_source *file)
{
    char head[11];
    return byte_source_read(file, 0, head, sizeof head) == sizeof head && head[4] == 16 &&
           memcmp(head + 8, "CR\2", 3) == 0;
}

static bool has_raw_page(const tiff_head *t)
{
    for (int i = 0; i < t->pages; i++) {
        if (is_raw_page(t, t->page[i]) || tiff_count(t, t->page[i], TIFF_DNG_VERSION)) return true;
        for (uint64_t k = 0; k < MOST_BELOW && k < tiff_count(t, t->page[i], TIFF_BELOW); k++)
            if (is_raw_page(t, tiff_value_at(t, t->page[i], TIFF_BELOW, k))) return true;
    }
    return false;
}

static uint64_t pixels_of(const tiff_head *t, uint64_t page)
{
    return (uint64_t)tiff_value(t, page, TIFF_WIDTH) * tiff_value(t, page, TIFF_HEIGHT);
}

/* Returns the largest page that is not a reduced copy or a mask, -1 if there is none; others: number of pages more than
 * half as large. */
static int find_page(const tiff_head *t, int *others)
{
    int best = -1;
    *others = 0;
    for (int i = 0; i < t->pages; i++) {
        if (tiff_value(t, t->page[i], TIFF_KIND) & (REDUCED | MASK)) continue;
        if (best < 0 || pixels_of(t, t->page[i]) > pixels_of(t, t->page[best])) best = i;
    }
    for (int i = 0; best >= 0 && i < t->pages; i++)
        *others += i != best && !(tiff_value(t, t->page[i], TIFF_KIND) & (REDUCED | MASK)) &&
                   pixels_of(t, t->page[i]) > pixels_of(t, t->page[best]) / 2;
    return best;
}

static unsigned big16(const unsigned char *p)
{
    return (unsigned)p[0] << 8 | p[1];
}

/* Returns the number of samples that the JPEG at a position claims in its frame header; 0 if none is found. */
static uint64_t jpeg_samples(byte_source *file, uint64_t at)
{
    unsigned char head[1024];
    size_t size = byte_source_read(file, at, head, sizeof head);
    if (size < 4 || head[0] != 0xff || head[1] != 0xd8) return 0;
    for (size_t i = 2; i + 10 <= size && head[i] == 0xff; i += 2 + big16(head + i + 2))
        if (head[i + 1] >= 0xc0 && head[i + 1] <= 0xc3)
            return (uint64_t)big16(head + i + 5) * big16(head + i + 7) * head[i + 9];
    return 0;
}

/* Tells whether the parts of a raw page claim to be far larger than the page: a decoder would allocate them. */
static bool is_overfull(const tiff_head *t, uint64_t page)
{
    enum { MOST_PARTS = 4096, SPARE = 4 };
    if (!is_raw_page(t, page) || tiff_value(t, page, TIFF_COMPRESSION) != JPEG) return false;
    unsigned tag = tiff_count(t, page, TIFF_TILES) ? TIFF_TILES : TIFF_STRIPS;
    uint64_t parts = tiff_count(t, page, tag), sum = 0, samples = tiff_value(t, page, TIFF_SAMPLES);
    for (uint64_t i = 0; i < parts && i < MOST_PARTS; i++)
        sum += jpeg_samples(t->from, tiff_value_at(t, page, tag, i));
    const uint64_t border = 1 << 20; /* of tiles that reach beyond the page */
    return sum > SPARE * pixels_of(t, page) * (samples ? samples : 1) + border;
}

bool picture_tiff_is_overfull(const char *path)
{
    tiff_head t;
    byte_source file;
    if (!byte_source_open(&file, path)) return false;
    bool found = false;
    bool known = tiff_open(&t, &file);
    for (int i = 0; known && i < t.pages; i++) {
        found |= is_overfull(&t, t.page[i]);
        for (uint64_t k = 0; k < MOST_BELOW && k < tiff_count(&t, t.page[i], TIFF_BELOW); k++)
            found |= is_overfull(&t, tiff_value_at(&t, t.page[i], TIFF_BELOW, k));
    }
    byte_source_close(&file);
    return found;
}

bool picture_tiff_is_raw(const char *path)
{
    tiff_head t;
    byte_source file;
    if (!byte_source_open(&file, path)) return false;
    int others;
    bool raw = tiff_open(&t, &file) &&
               (is_canon(&file) || has_raw_page(&t) || (t.pages < TIFF_MOST_PAGES && find_page(&t, &others) < 0));
    byte_source_close(&file);
    return raw;
}

/* Checks the bytes that libvips would hold: a strip, a row of tiles, or everything if the samples are in planes. */
static status check_samples(const tiff_head *t, uint64_t page, const char *path)
{
    uint32_t samples = tiff_value(t, page, TIFF_SAMPLES), bits = tiff_value(t, page, TIFF_BITS);
    uint32_t width = tiff_value(t, page, TIFF_WIDTH), height = tiff_value(t, page, TIFF_HEIGHT);
    uint32_t most = tiff_value(t, page, TIFF_PHOTOMETRIC) == CMYK ? 5 : 4;
    if (samples > most)
        return fail(
            MERLIN_BAD_INPUT,
            "cannot read %s: it has %u samples a pixel, not the %u at most of grey or colour with alpha; save it "
            "as RGB",
            path, samples, most);
    status s = picture_check_size(path, width, height);
    uint32_t strip = tiff_value(t, page, TIFF_STRIP_HEIGHT);
    if (s != OK || !strip) return s;
    int bytes = (int)((samples ? samples : 1) * (bits > 8 ? bits / 8 : 1));
    return picture_check_whole(path, width, strip < height ? strip : height, bytes < 64 ? bytes : 64, "in more strips");
}

/* Refuses samples that libvips would misinterpret, or refuse in terms for programmers. */
static status check_meaning(const tiff_head *t, uint64_t page, const char *path)
{
    enum { ICC_LAB = 9, ITU_LAB = 10, LOG_L = 32844, LOG_LUV = 32845, SIGNED = 2, FLOATS = 3 };
    uint32_t meaning = tiff_value(t, page, TIFF_PHOTOMETRIC), bits = tiff_value(t, page, TIFF_BITS);
    uint32_t format = tiff_value(t, page, TIFF_SAMPLE_FORMAT);
    if (meaning == ICC_LAB || meaning == ITU_LAB)
        return fail(MERLIN_BAD_INPUT, "cannot read %s: its colours are %s L*a*b*; save it as RGB", path,
                    meaning == ICC_LAB ? "ICC" : "ITU");
    const bool grey = tiff_value(t, page, TIFF_SAMPLES) <= 1; /* or a palette */
    bool whole = (grey && (bits <= 2 || bits == 4)) || bits == 8 || bits == 16;
    bool logarithmic = meaning == LOG_L || meaning == LOG_LUV; /* their decoder returns floats */
    if (logarithmic || (format == FLOATS ? bits == 32 : format != SIGNED && whole)) return OK;
    return fail(MERLIN_BAD_INPUT,
                "cannot read %s: its samples are %s of %u bits; whole ones of 8 or 16 bits without a sign, or floats "
                "of 32, are read",
                path,
                format == FLOATS   ? "floats"
                : format == SIGNED ? "whole numbers with a sign"
                                   : "whole numbers",
                bits);
}

static status check_open(const tiff_head *t, const char *path, picture_tiff_page *out)
{
    int others, found = find_page(t, &others);
    if (found < 0) found = 0;
    uint64_t page = t->page[found];
    *out = (picture_tiff_page){.number = found, .pages = t->pages};
    if (others)
        return fail(MERLIN_BAD_INPUT,
                    "cannot read %s: it has %d pages of about the same size; save the one that is meant", path,
                    others + 1);
    status s = check_meaning(t, page, path);
    if (s != OK) return s;
    /* JPEG's decoder converts those to RGB */
    if (tiff_value(t, page, TIFF_PHOTOMETRIC) == YCBCR && tiff_value(t, page, TIFF_COMPRESSION) != JPEG)
        return fail(MERLIN_BAD_INPUT, "cannot read %s: its colours are YCbCr; save it as RGB", path);
    out->premultiplied =
        tiff_count(t, page, TIFF_EXTRA_SAMPLES) == 1 && tiff_value(t, page, TIFF_EXTRA_SAMPLES) == ASSOCIATED;
    s = check_samples(t, page, path);
    return s == OK ? picture_tiff_light(t, page, path, &out->light) : s;
}

status picture_check_tiff(const char *path, picture_tiff_page *out)
{
    tiff_head t;
    byte_source file;
    if (!byte_source_open(&file, path)) return fail_by_errno(MERLIN_BAD_INPUT, "cannot read %s", path);
    status s = tiff_open(&t, &file) ? check_open(&t, path, out)
                                    : fail(MERLIN_BAD_INPUT, "cannot read %s: it is damaged or cut short", path);
    byte_source_close(&file);
    return s;
}
