/* SPDX-License-Identifier: MIT */
/* TGA, by Truevision's file format specification 2.0: colour-mapped, true colour and grey, run-length coded or not. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "image/plain/plain_file.h"

enum { HEAD = 18, MAPPED = 1, TRUE_COLOUR = 2, RUNS = 8, LONGEST_RUN = 128 };

/* A pixel as stored, or an entry of the colour map. */
typedef struct pixel {
    uint8_t bytes[4];
} pixel;

typedef struct tga {
    int kind, bits;   /* kind of picture; bits of a pixel, or of a map entry */
    int bytes;        /* bytes of a pixel in the file */
    bool runs;        /* run-length coded */
    bool repeats;     /* the current run repeats one pixel */
    int left;         /* pixels left in the run */
    uint8_t again[4]; /* the repeated pixel */
    uint8_t *map;     /* colour map, 4 bytes an entry */
    unsigned first, count;
} tga;

/* Facts from the extension area: the kind of alpha, 0 to 4, or -1 without one; the curve's exponent, or 0. */
typedef struct extension {
    int alpha;
    double gamma;
} extension;

enum { ALPHA_IS_COVER = 3, ALPHA_IS_MULTIPLIED = 4 };

/* Reads the extension area, whose position is in the footer at the file's end. */
static extension find_extension(plain_file *f)
{
    enum { FOOTER = 26, AREA = 495, GAMMA = 478, ALPHA = 494 };
    uint8_t footer[FOOTER], area[AREA];
    extension found = {.alpha = -1};
    off_t here = ftello(f->file);
    bool there = fseeko(f->file, -FOOTER, SEEK_END) == 0 && plain_get(f, footer, FOOTER) &&
                 memcmp(footer + 8, "TRUEVISION-XFILE.", 18) == 0 && plain_little32(footer) != 0 &&
                 fseeko(f->file, (off_t)plain_little32(footer), SEEK_SET) == 0 && plain_get(f, area, AREA) &&
                 plain_little16(area) >= AREA;
    if (there) {
        unsigned over = plain_little16(area + GAMMA), under = plain_little16(area + GAMMA + 2);
        found = (extension){area[ALPHA], under ? (double)over / under : 0};
    }
    (void)fseeko(f->file, here, SEEK_SET);
    return found;
}

/* Sets the curve: near the gamma of screens it is sRGB's, as for PNGs. */
static void set_light(plain_file *f, double gamma)
{
    const double screen = 2.2;
    if (!(gamma >= 1 && gamma <= 10)) return;
    f->layout.light = picture_light_of_power((float)gamma);
    if (fabs(gamma - screen) < 0.1) f->layout.light = (picture_light){.said = true};
}

/* Sets the layout; attributes: number of a pixel's bits that the header calls so. */
static void set_layout(plain_file *f, const tga *t, int attributes)
{
    extension e = find_extension(f);
    bool has_bits =
        t->bits == 32 || (t->bits == 16 && (t->kind == TRUE_COLOUR || t->kind == MAPPED || attributes == 8));
    bool alpha =
        has_bits && (e.alpha < 0 ? attributes > 0 : e.alpha == ALPHA_IS_COVER || e.alpha == ALPHA_IS_MULTIPLIED);
    bool grey = t->kind != MAPPED && t->kind != TRUE_COLOUR;
    f->layout.bands = (grey ? 1 : 3) + alpha;
    f->layout.alpha = alpha;
    f->layout.premultiplied = alpha && e.alpha == ALPHA_IS_MULTIPLIED;
    f->layout.sample = PICTURE_UINT8;
    f->bits = 8;
    set_light(f, e.gamma);
}

static status read_map(plain_file *f, tga *t, const uint8_t *head)
{
    int bits = head[7], bytes = (bits + 7) / 8;
    t->first = plain_little16(head + 3);
    t->count = plain_little16(head + 5);
    if (!head[1]) t->count = 0;
    if (t->kind != MAPPED) return fseeko(f->file, (off_t)t->count * bytes, SEEK_CUR) == 0 ? OK : plain_damaged(f);
    t->bits = bits;
    t->map = calloc(t->count ? t->count : 1, 4);
    if (!t->map) return fail(MERLIN_NO_MEMORY, "no memory to read %s", f->path);
    for (unsigned i = 0; i < t->count; i++)
        if (!plain_get(f, t->map + 4 * (size_t)i, (size_t)bytes)) return plain_damaged(f);
    return OK;
}

static bool has_color(int bits)
{
    return bits == 15 || bits == 16 || bits == 24 || bits == 32;
}

static bool is_known(const tga *t, const uint8_t *head)
{
    if (t->kind != MAPPED)
        return t->kind == TRUE_COLOUR ? has_color(t->bits) : t->kind == 3 && (t->bits == 8 || t->bits == 16);
    return head[1] == 1 && t->bits == 8 && has_color(head[7]);
}

static status tga_open(plain_file *f, void **state)
{
    uint8_t head[HEAD];
    tga *t = calloc(1, sizeof *t);
    *state = t;
    if (!t) return fail(MERLIN_NO_MEMORY, "no memory to read %s", f->path);
    if (!plain_get(f, head, HEAD)) return plain_damaged(f);
    t->runs = head[2] & RUNS;
    t->kind = head[2] & ~RUNS;
    t->bits = head[16];
    t->bytes = (t->bits + 7) / 8;
    if (!is_known(t, head))
        return fail(MERLIN_BAD_INPUT,
                    "cannot read %s: it is a TGA of type %d with %d bits a pixel, which is not read here", f->path,
                    head[2], head[16]);
    f->layout.width = (int)plain_little16(head + 12);
    f->layout.height = (int)plain_little16(head + 14);
    double pixels = (double)f->layout.width * f->layout.height;
    status s = plain_check(f, t->runs ? pixels / LONGEST_RUN * (1 + t->bytes) : pixels * t->bytes);
    if (s == OK && fseeko(f->file, HEAD + head[0], SEEK_SET) != 0) s = plain_damaged(f);
    if (s == OK) s = read_map(f, t, head);
    if (s != OK) return s;
    bool from_right = head[17] & 0x10, from_top = head[17] & 0x20;
    f->layout.orientation = from_top ? (from_right ? 2 : 1) : from_right ? 3 : 4;
    set_layout(f, t, head[17] & 15);
    return OK;
}

/* Reads the next pixel's bytes; runs may extend over a row's end. */
static bool next_pixel(plain_file *f, tga *t, uint8_t *bytes)
{
    if (!t->runs) return plain_get(f, bytes, (size_t)t->bytes);
    if (t->left == 0) {
        int packet = getc(f->file);
        if (packet == EOF) return false;
        t->repeats = packet >= LONGEST_RUN;
        t->left = packet % LONGEST_RUN + 1;
        if (t->repeats && !plain_get(f, t->again, (size_t)t->bytes)) return false;
    }
    t->left--;
    if (!t->repeats) return plain_get(f, bytes, (size_t)t->bytes);
    memcpy(bytes, t->again, sizeof t->again);
    return true;
}

static uint8_t widen(unsigned five)
{
    return (uint8_t)((five * 255 + 15) / 31);
}

static void put_colour(const tga *t, const uint8_t *p, bool alpha, uint8_t *to)
{
    if (t->bits > 16) {
        for (int c = 0; c < 3; c++)
            to[c] = p[2 - c];
        if (alpha) to[3] = p[3];
        return;
    }
    unsigned code = plain_little16(p);
    for (int c = 0; c < 3; c++)
        to[c] = widen(code >> (10 - 5 * c) & 31);
    if (alpha) to[3] = code & 0x8000 ? 255 : 0;
}

static bool tga_row(plain_file *f, void *state, void *samples)
{
    tga *t = state;
    size_t bands = (size_t)f->layout.bands;
    for (int x = 0; x < f->layout.width; x++) {
        uint8_t bytes[4] = {0}, *to = (uint8_t *)samples + (size_t)x * bands;
        if (!next_pixel(f, t, bytes)) return false;
        if (t->kind == MAPPED) {
            if (bytes[0] < t->first || bytes[0] - t->first >= t->count) return false;
            memcpy(bytes, t->map + 4 * (size_t)(bytes[0] - t->first), 4);
        }
        if (t->kind == MAPPED || t->kind == TRUE_COLOUR)
            put_colour(t, bytes, f->layout.alpha, to);
        else
            memcpy(to, bytes, bands);
    }
    return true;
}

static void tga_close(void *state)
{
    tga *t = state;
    if (t) free(t->map);
    free(t);
}

const plain_format plain_tga = {tga_open, tga_row, tga_close};
