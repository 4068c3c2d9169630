/* SPDX-License-Identifier: MIT */
#include "image/formats/picture_dng.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "image/formats/float_part.h"
#include "image/formats/picture_rows.h"
#include "image/metadata/tiff_head.h"
#include "image/primaries.h"

enum { MOSAIC = 32803, LINEAR_RAW = 34892, FLOATS = 3, D65 = 21, MOST_BELOW = 8 };
enum {
    MOSAIC_PERIOD = 33421,
    MOSAIC_PATTERN = 33422,
    BLACK_LEVEL = 50714,
    WHITE_LEVEL = 50717,
    COLOUR_MATRIX_1 = 50721,
    COLOUR_MATRIX_2 = 50722,
    NEUTRAL = 50728,
    ILLUMINANT_2 = 50779,
    ACTIVE_AREA = 50829,
};

typedef struct dng {
    tiff_head t;
    const char *path;
    uint64_t page, size; /* page: its position; size: of the file, bytes */
    float_parts parts;
    unsigned places, sizes; /* tags of the parts' positions and sizes */
    int left, top, right, bottom;
    bool mosaic;
    uint8_t pattern[4];
    float *band; /* rows of parts, from band_top on */
    int band_top, band_rows;
    double mix[9]; /* camera colours to sRGB's primaries, white balance included */
} dng;

static bool is_float_page(const tiff_head *t, uint64_t page)
{
    uint32_t meaning = tiff_value(t, page, TIFF_PHOTOMETRIC);
    return (meaning == MOSAIC || meaning == LINEAR_RAW) && tiff_value(t, page, TIFF_SAMPLE_FORMAT) == FLOATS;
}

static uint64_t larger_page(const tiff_head *t, uint64_t best, uint64_t page)
{
    if (!is_float_page(t, page)) return best;
    return !best || tiff_value(t, page, TIFF_WIDTH) > tiff_value(t, best, TIFF_WIDTH) ? page : best;
}

/* Finds the largest page of raw floats; returns 0 if there is none. */
static uint64_t find_page(const tiff_head *t)
{
    uint64_t best = 0;
    for (int i = 0; i < t->pages; i++) {
        best = larger_page(t, best, t->page[i]);
        for (uint64_t k = 0; k < MOST_BELOW && k < tiff_count(t, t->page[i], TIFF_BELOW); k++)
            best = larger_page(t, best, tiff_value_at(t, t->page[i], TIFF_BELOW, k));
    }
    return best;
}

bool picture_is_float_dng(const char *path)
{
    tiff_head t;
    byte_source file;
    if (!byte_source_open(&file, path)) return false;
    bool found = tiff_open(&t, &file) && find_page(&t) != 0;
    byte_source_close(&file);
    return found;
}

static status damaged(const dng *d)
{
    return fail(MERLIN_BAD_INPUT, "cannot read %s: it is damaged or cut short", d->path);
}

static int number(const dng *d, unsigned tag, int otherwise)
{
    uint32_t value = tiff_value(&d->t, d->page, tag);
    return value && value <= INT32_MAX ? (int)value : otherwise;
}

static void find_parts(dng *d)
{
    bool tiles = tiff_count(&d->t, d->page, TIFF_TILES) > 0;
    float_parts *p = &d->parts;
    *p = (float_parts){.width = number(d, TIFF_WIDTH, 0),
                       .height = number(d, TIFF_HEIGHT, 0),
                       .samples = number(d, TIFF_SAMPLES, 1),
                       .bits = number(d, TIFF_BITS, 0),
                       .predictor = number(d, TIFF_PREDICTOR, 1),
                       .compression = number(d, TIFF_COMPRESSION, 1),
                       .big_endian = d->t.big_endian};
    p->part_width = tiles ? number(d, TIFF_TILE_WIDTH, 0) : p->width;
    p->part_height = tiles ? number(d, TIFF_TILE_HEIGHT, 0) : number(d, TIFF_STRIP_HEIGHT, p->height);
    if (!tiles && p->part_height > p->height) p->part_height = p->height;
    d->places = tiles ? TIFF_TILES : TIFF_STRIPS;
    d->sizes = tiles ? TIFF_TILE_SIZES : TIFF_STRIP_SIZES;
    d->mosaic = tiff_value(&d->t, d->page, TIFF_PHOTOMETRIC) == MOSAIC;
}

/* Finds the rectangle of pixels exposed to light: top, left, bottom, right. */
static void find_active_area(dng *d)
{
    uint32_t at[4];
    for (uint64_t i = 0; i < 4; i++)
        at[i] = tiff_value_at(&d->t, d->page, ACTIVE_AREA, i);
    d->right = d->parts.width;
    d->bottom = d->parts.height;
    if (at[0] >= at[2] || at[1] >= at[3] || at[2] > (uint32_t)d->bottom || at[3] > (uint32_t)d->right) return;
    d->top = (int)at[0];
    d->left = (int)at[1];
    d->bottom = (int)at[2];
    d->right = (int)at[3];
}

/* Computes the matrix from sRGB's primaries to camera colours, its rows scaled to map white to 1, and the factors by
 * which daylight does so. */
static void find_camera(const dng *d, double camera[9], double daylight[3])
{
    static const double xyz[9] = {0.4124564, 0.3575761, 0.1804375, 0.2126729, 0.7151522,
                                  0.0721750, 0.0193339, 0.1191920, 0.9503041};
    const uint64_t first = d->t.page[0];
    bool second = tiff_value(&d->t, first, ILLUMINANT_2) == D65;
    for (int i = 0; i < 3; i++) {
        double sum = 0;
        for (int j = 0; j < 3; j++) {
            camera[3 * i + j] = 0;
            for (int k = 0; k < 3; k++)
                camera[3 * i + j] +=
                    xyz[3 * k + j] * tiff_real_at(&d->t, first, second ? COLOUR_MATRIX_2 : COLOUR_MATRIX_1,
                                                  3 * (uint64_t)i + (uint64_t)k);
            sum += camera[3 * i + j];
        }
        for (int j = 0; j < 3; j++)
            camera[3 * i + j] = fabs(sum) > 1e-6 ? camera[3 * i + j] / sum : i == j;
        daylight[i] = fabs(sum) > 1e-6 ? 1 / sum : 1;
    }
}

/* Computes the white balance, as the camera was set or for daylight; the smallest factor is 1. */
static void find_mix(dng *d, bool as_set)
{
    double camera[9], by[3], least = INFINITY;
    find_camera(d, camera, by);
    for (uint64_t i = 0; i < 3; i++) {
        double neutral = tiff_real_at(&d->t, d->t.page[0], NEUTRAL, i);
        if (as_set && neutral > 0) by[i] = 1 / neutral;
        least = by[i] > 0 ? fmin(least, by[i]) : least;
    }
    if (!primaries_invert(camera, d->mix)) memcpy(d->mix, (const double[9]){1, 0, 0, 0, 1, 0, 0, 0, 1}, sizeof d->mix);
    for (int i = 0; i < 9; i++)
        d->mix[i] *= isfinite(least) ? by[i % 3] / least : 1;
}

/* Refuses variants that are not supported. A mosaic must be held as a whole, as a pixel's colours come from its
 * neighbours. */
static status check(dng *d)
{
    const float_parts *p = &d->parts;
    const double most_of_a_byte = 1032; /* largest ratio of deflate */
    status s = picture_check_size(d->path, p->width, p->height);
    if (s != OK) return s;
    bool channels = d->mosaic ? p->samples == 1 : p->samples == 1 || p->samples == 3;
    if (!channels || (p->bits != 16 && p->bits != 24 && p->bits != 32) || number(d, TIFF_PLANES, 1) != 1)
        return fail(MERLIN_BAD_INPUT, "cannot read %s: a raw picture of %d floats of %d bits a pixel is not read here",
                    d->path, p->samples, p->bits);
    if (p->compression != 1 && p->compression != 8 && p->compression != 32946)
        return fail(MERLIN_BAD_INPUT, "cannot read %s: its floats are compressed in a way (%d) that is not read here",
                    d->path, p->compression);
    if (p->part_width < 1 || p->part_height < 1 || p->part_width > p->width + 4096 || p->part_height > p->height + 4096)
        return damaged(d);
    double bytes = (double)p->width * p->height * p->samples * p->bits / 8;
    if (bytes > most_of_a_byte * (double)d->size) return damaged(d);
    d->band_rows = d->mosaic ? (p->height + p->part_height - 1) / p->part_height * p->part_height : p->part_height;
    return picture_check_whole(d->path, p->width + 4096, d->band_rows, 8 * p->samples, "in smaller tiles");
}

static status check_mosaic(dng *d)
{
    for (uint64_t i = 0; d->mosaic && i < 4; i++) {
        uint32_t color = tiff_value_at(&d->t, d->page, MOSAIC_PATTERN, i);
        if (tiff_value(&d->t, d->page, MOSAIC_PERIOD) != 2 || tiff_value_at(&d->t, d->page, MOSAIC_PERIOD, 1) != 2 ||
            color > 2)
            return fail(MERLIN_BAD_INPUT,
                        "cannot read %s: its floats are a mosaic of another kind than red, green and blue in "
                        "squares of 2 x 2; develop it to a TIFF first",
                        d->path);
        d->pattern[i] = (uint8_t)color;
    }
    return OK;
}

/* Copies a part's floats to their position in the band. */
static void place_part(dng *d, const float *floats, int x, int y)
{
    const float_parts *p = &d->parts;
    size_t samples = (size_t)p->samples, width = (size_t)(p->width - x < p->part_width ? p->width - x : p->part_width);
    for (int row = 0; row < p->part_height && y + row < p->height; row++)
        memcpy(d->band + ((size_t)(y + row - d->band_top) * (size_t)p->width + (size_t)x) * samples,
               floats + (size_t)row * (size_t)p->part_width * samples, width * samples * sizeof *floats);
}

typedef struct room {
    void *data, *bytes;
    float *floats;
    size_t most; /* bytes of a part in the file */
    struct libdeflate_decompressor *inflater;
} room;

static status lack(const dng *d)
{
    return fail(MERLIN_NO_MEMORY, "no memory to read %s", d->path);
}

static status read_part(const dng *d, room *r, int across, int x, int y)
{
    float_parts p = d->parts;
    bool strips = d->places == TIFF_STRIPS;
    if (strips && p.height - y < p.part_height) p.part_height = p.height - y;
    uint64_t index = (uint64_t)(y / d->parts.part_height) * (uint64_t)across + (uint64_t)(x / p.part_width);
    uint64_t at = tiff_value_at(&d->t, d->page, d->places, index),
             size = tiff_value_at(&d->t, d->page, d->sizes, index);
    if (size == 0 || size > d->size || at > d->size - size) return damaged(d);
    if (size > r->most) {
        void *grown = realloc(r->data, size);
        if (!grown) return lack(d);
        r->data = grown;
        r->most = size;
    }
    const bool good = byte_source_read(d->t.from, at, r->data, size) == size &&
                      float_part_unpack(&p, r->inflater, r->data, size, r->bytes, r->floats);
    return good ? OK : damaged(d);
}

/* Reads the parts of the band that begins at row `top`. */
static status fill_band(dng *d, room *r, int top)
{
    const float_parts *p = &d->parts;
    int across = (p->width + p->part_width - 1) / p->part_width;
    d->band_top = top;
    for (int y = top; y < p->height && y < top + d->band_rows; y += p->part_height)
        for (int x = 0; x < p->width; x += p->part_width) {
            status s = read_part(d, r, across, x, y);
            if (s != OK) return s;
            place_part(d, r->floats, x, y);
        }
    return OK;
}

static float level(const dng *d, unsigned tag, int place, double otherwise)
{
    uint64_t count = tiff_count(&d->t, d->page, tag);
    if (!count) return (float)otherwise;
    return (float)tiff_real_at(&d->t, d->page, tag, (uint64_t)place < count ? (uint64_t)place : 0);
}

/* Scales the band's values to 0 for black and 1 for white. */
static void scale_band(dng *d)
{
    const float_parts *p = &d->parts;
    float black[4], by[4];
    for (int i = 0; i < 4; i++) {
        black[i] = level(d, BLACK_LEVEL, i, 0);
        float white = level(d, WHITE_LEVEL, d->mosaic ? 0 : i, 1);
        by[i] = white > black[i] ? 1 / (white - black[i]) : 1;
    }
    for (int y = 0; y < d->band_rows; y++)
        for (int i = 0; i < p->width * p->samples; i++) {
            int k = d->mosaic ? (d->band_top + y - d->top) % 2 * 2 + abs(i - d->left) % 2 : i % p->samples;
            float *value = &d->band[(size_t)y * (size_t)p->width * (size_t)p->samples + (size_t)i];
            *value = (*value - black[k & 3]) * by[k & 3];
        }
}

/* Computes the three colours at a pixel of a mosaic: its own sample, and the means of the others in its 3 × 3
 * neighbourhood. */
static void see_mosaic(const dng *d, int x, int y, float seen[3])
{
    float sum[3] = {0}, count[3] = {0};
    for (int v = y - 1; v <= y + 1; v++)
        for (int u = x - 1; u <= x + 1; u++) {
            if (u < d->left || v < d->top || u >= d->right || v >= d->bottom) continue;
            int c = d->pattern[(v - d->top) % 2 * 2 + (u - d->left) % 2];
            sum[c] += d->band[(size_t)v * (size_t)d->parts.width + (size_t)u];
            count[c]++;
        }
    for (int c = 0; c < 3; c++)
        seen[c] = count[c] > 0 ? sum[c] / count[c] : 0;
    seen[d->pattern[(y - d->top) % 2 * 2 + (x - d->left) % 2]] =
        d->band[(size_t)y * (size_t)d->parts.width + (size_t)x];
}

static void see_row(const dng *d, int y, float *line)
{
    const float_parts *p = &d->parts;
    for (int x = d->left; x < d->right; x++) {
        const float *at = d->band + ((size_t)(y - d->band_top) * (size_t)p->width + (size_t)x) * (size_t)p->samples;
        float seen[3];
        if (!d->mosaic && p->samples == 1) {
            *line++ = fmaxf(*at, 0);
            continue;
        }
        if (d->mosaic)
            see_mosaic(d, x, y, seen);
        else
            memcpy(seen, at, sizeof seen);
        for (int c = 0; c < 3; c++) {
            double sum = 0;
            for (int k = 0; k < 3; k++)
                sum += d->mix[3 * c + k] * (double)seen[k];
            *line++ = sum < 0 ? 0 : (float)sum; /* values that are not finite stay, to be reported later */
        }
    }
}

static status put_bands(dng *d, room *r, picture_rows *rows, float *line)
{
    for (int top = 0; top < d->parts.height; top += d->band_rows) {
        status s = fill_band(d, r, top);
        if (s != OK) return s;
        scale_band(d);
        for (int y = top; y < top + d->band_rows && y < d->bottom; y++) {
            if (y < d->top) continue;
            see_row(d, y, line);
            picture_rows_put(rows, y - d->top, line);
        }
    }
    return OK;
}

static status read_bands(dng *d, picture_rows *rows)
{
    const float_parts *p = &d->parts;
    size_t part = (size_t)p->part_width * (size_t)p->part_height * (size_t)p->samples;
    room r = {.bytes = malloc(part * (size_t)p->bits / 8),
              .floats = malloc(part * sizeof(float)),
              .inflater = libdeflate_alloc_decompressor()};
    float *line = malloc((size_t)(d->right - d->left) * 3 * sizeof *line);
    d->band = calloc((size_t)p->width * (size_t)d->band_rows * (size_t)p->samples, sizeof *d->band);
    const bool enough = r.bytes && r.floats && r.inflater && line && d->band;
    status s = enough ? put_bands(d, &r, rows, line) : lack(d);
    free(d->band);
    free(line);
    free(r.data);
    free(r.bytes);
    free(r.floats);
    libdeflate_free_decompressor(r.inflater);
    return s;
}

static status read_open(dng *d, picture_colour how, img *color, picture_head *head)
{
    d->page = find_page(&d->t);
    find_parts(d);
    status s = check(d);
    if (s == OK) s = check_mosaic(d);
    if (s != OK) return s;
    find_active_area(d);
    *head = (picture_head){.width = d->right - d->left, .height = d->bottom - d->top, .bits = 32};
    if (!color) return OK;
    find_mix(d, how == PICTURE_LINEARIZE);
    uint32_t turned = tiff_value(&d->t, d->t.page[0], TIFF_ORIENTATION);
    const picture_layout layout = {.width = head->width,
                                   .height = head->height,
                                   .bands = d->mosaic ? 3 : d->parts.samples,
                                   .sample = PICTURE_FLOAT,
                                   .orientation = turned <= 8 ? (int)turned : 1};
    picture_rows *rows;
    s = picture_rows_new(&layout, PICTURE_AS_IT_IS, color, NULL, &rows);
    if (s == OK) s = read_bands(d, rows);
    picture_rows_free(rows);
    return s;
}

status picture_read_float_dng(const char *path, picture_colour how, img *color, picture_head *head)
{
    dng d = {.path = path};
    byte_source file;
    if (!byte_source_open(&file, path)) return fail_by_errno(MERLIN_BAD_INPUT, "cannot read %s", path);
    status s = tiff_open(&d.t, &file) ? OK : damaged(&d);
    d.size = file.size;
    if (s == OK) s = read_open(&d, how, color, head);
    byte_source_close(&file);
    return s;
}
