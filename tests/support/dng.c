/* SPDX-License-Identifier: MIT */
#include "dng.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BYTE = 1, ASCII = 2, SHORT = 3, LONG = 4, RATIONAL = 5, SIGNED_RATIONAL = 10 };
enum { BLACK = 512, WHITE = 16000, ENTRIES = 32, ROOM = 8192 };

/* A TIFF being built: directories of entries, then their values, then pixels. */
typedef struct tiff {
    uint8_t *data;
    uint32_t size, entries_at;
    bool big_endian;
} tiff;

static void put(tiff *t, uint32_t at, uint32_t value, int bytes)
{
    for (int i = 0; i < bytes; i++)
        t->data[at + (uint32_t)(t->big_endian ? bytes - 1 - i : i)] = (uint8_t)(value >> 8 * i);
}

static void open_folder(tiff *t)
{
    t->entries_at = t->size + 2;
    put(t, t->size, 0, 2);
    t->size += 2 + 12 * ENTRIES + 4;
}

/* Adds an entry; values: as many numbers as there are in the file, two for a fraction. */
static void add(tiff *t, uint32_t tag, uint32_t type, uint32_t count, const uint32_t *values)
{
    const int bytes = type == SHORT ? 2 : type == BYTE || type == ASCII ? 1 : 4;
    uint32_t numbers = type == RATIONAL || type == SIGNED_RATIONAL ? 2 * count : count, folder = t->entries_at - 2;
    uint32_t at, entry, used = (uint32_t)t->data[folder + t->big_endian];
    entry = t->entries_at + 12 * used;
    put(t, folder, used + 1, 2);
    put(t, entry, tag, 2);
    put(t, entry + 2, type, 2);
    put(t, entry + 4, count, 4);
    at = entry + 8;
    if (numbers * (uint32_t)bytes > 4) {
        put(t, at, t->size, 4);
        at = t->size;
        t->size += numbers * (uint32_t)bytes;
    }
    for (uint32_t i = 0; i < numbers; i++)
        put(t, at + i * (uint32_t)bytes, values[i], bytes);
}

static void add_one(tiff *t, uint32_t tag, uint32_t type, uint32_t value)
{
    add(t, tag, type, 1, &value);
}

static void add_words(tiff *t, uint32_t tag, const char *words)
{
    uint32_t letters[64], count = (uint32_t)strlen(words) + 1;
    for (uint32_t i = 0; i < count; i++)
        letters[i] = (uint8_t)words[i];
    add(t, tag, ASCII, count, letters);
}

static void add_fractions(tiff *t, uint32_t tag, uint32_t type, uint32_t count, const float *values)
{
    uint32_t numbers[32];
    for (uint32_t i = 0; i < count; i++) {
        numbers[2 * i] = (uint32_t)(int32_t)lrintf(values[i] * 10000);
        numbers[2 * i + 1] = 10000;
    }
    add(t, tag, type, count, numbers);
}

static void add_size(tiff *t, uint32_t width, uint32_t height, uint32_t bits, uint32_t channels, uint32_t meaning)
{
    const uint32_t all_bits[3] = {bits, bits, bits};
    add_one(t, 256, LONG, width);
    add_one(t, 257, LONG, height);
    add(t, 258, SHORT, channels, all_bits);
    add_one(t, 259, SHORT, 1);
    add_one(t, 262, SHORT, meaning);
    add_one(t, 277, SHORT, channels);
    add_one(t, 278, LONG, height);
    add_one(t, 279, LONG, width * height * channels * bits / 8);
}

static void add_camera(tiff *t, const dng *d)
{
    static const uint32_t version[4] = {1, 4, 0, 0};
    static const float from_xyz[9] = {3.2405f, -1.5371f, -0.4985f, -0.9693f, 1.8760f,
                                      0.0416f, 0.0556f,  -0.2040f, 1.0572f};
    add_words(t, 271, "Merlin");
    add_words(t, 272, "Test camera");
    add_one(t, 274, SHORT, (uint32_t)d->orientation);
    add(t, 50706, BYTE, 4, version);
    add_words(t, 50708, "Merlin test camera");
    add_fractions(t, 50721, SIGNED_RATIONAL, 9, from_xyz);
    add_fractions(t, 50728, RATIONAL, 3, d->neutral);
    add_one(t, 50778, SHORT, 21); /* D65 */
}

static void add_mosaic_words(tiff *t)
{
    static const uint32_t period[2] = {2, 2}, pattern[4] = {0, 1, 1, 2};
    add(t, 33421, SHORT, 2, period);
    add(t, 33422, BYTE, 4, pattern);
}

static void add_mosaic(tiff *t, const dng *d)
{
    add_one(t, 254, LONG, 0);
    add_size(t, (uint32_t)d->width, (uint32_t)d->height, 16, 1, 32803);
    add_one(t, 50714, SHORT, BLACK);
    add_one(t, 50717, SHORT, WHITE);
}

static void put_codes(tiff *t, const dng *d)
{
    add_one(t, 273, LONG, t->size);
    for (int y = 0; y < d->height; y++)
        for (int x = 0; x < d->width; x++, t->size += 2) {
            float seen = fminf(d->see(x, y, y % 2 + x % 2), 1);
            put(t, t->size, (uint32_t)lrintf(BLACK + seen * (WHITE - BLACK)), 2);
        }
}

/* Returns a float, which must be representable, as a code of so many bits. */
static uint32_t float_code(float value, int bits)
{
    if (value == 0) return 0;
    const int fraction = bits == 16 ? 10 : bits == 24 ? 16 : 23, bias = bits == 16 ? 15 : bits == 24 ? 63 : 127;
    int exponent;
    float whole = frexpf(value, &exponent);
    return (uint32_t)(exponent - 1 + bias) << fraction | (uint32_t)((2 * whole - 1) * (float)(1 << fraction));
}

/* Returns a row of floats as bytes, possibly as differences to the previous pixel, grouped by significance. */
static void float_row(const dng *d, int y, uint8_t *row)
{
    const int channels = d->linear ? 3 : 1, bytes = d->floats / 8, count = d->width * channels;
    for (int i = 0; i < count; i++) {
        int x = i / channels, c = d->linear ? i % 3 : y % 2 + x % 2;
        uint32_t code = float_code(d->see(x, y, c) * (d->exceeds > 0 ? d->exceeds : 1), d->floats);
        for (int k = 0; k < bytes; k++)
            row[d->planes ? k * count + i : i * bytes + k] =
                (uint8_t)(code >> 8 * (d->planes || d->big_endian ? bytes - 1 - k : k));
    }
    for (int i = count * bytes - 1; d->planes && i >= channels; i--)
        row[i] = (uint8_t)(row[i] - row[i - channels]);
}

/* Appends rows in zlib's format, one stored block a row, with RFC 1950's checksum at the end. */
static void put_deflated_rows(tiff *t, const dng *d, int first, int end)
{
    const uint32_t bytes = (uint32_t)(d->width * (d->linear ? 3 : 1) * d->floats / 8);
    uint32_t a = 1, b = 0, start = t->size;
    t->data[t->size++] = 0x78;
    t->data[t->size++] = 0x01;
    for (int y = first; y < end; y++) {
        uint8_t *block = t->data + t->size;
        block[0] = y + 1 == end;
        for (int k = 0; k < 4; k++)
            block[1 + k] = (uint8_t)((k < 2 ? bytes : ~bytes) >> 8 * (k % 2));
        float_row(d, y, block + 5);
        for (uint32_t i = 0; i < bytes; i++) {
            a = (a + block[5 + i]) % 65521;
            b = (b + a) % 65521;
        }
        t->size += 5 + bytes;
    }
    for (int k = 3; k >= 0; k--)
        t->data[t->size++] = (uint8_t)((b << 16 | a) >> 8 * k);
    t->size += (t->size - start) & 1;
}

/* Appends strips of 24 rows, the last possibly shorter. */
static void put_floats(tiff *t, const dng *d)
{
    enum { ROWS = 24, MOST = 16 };
    const uint32_t of_floats[3] = {3, 3, 3},
                   all_bits[3] = {(uint32_t)d->floats, (uint32_t)d->floats, (uint32_t)d->floats};
    const uint32_t channels = d->linear ? 3 : 1;
    uint32_t places[MOST], sizes[MOST], count = 0;
    uint32_t folder = t->entries_at, behind = t->size;
    t->size += 512; /* for the values of the entries added below */
    for (int y = 0; y < d->height; y += ROWS, count++) {
        places[count] = t->size;
        put_deflated_rows(t, d, y, y + ROWS < d->height ? y + ROWS : d->height);
        sizes[count] = t->size - places[count];
    }
    uint32_t end = t->size;
    t->size = behind;
    t->entries_at = folder;
    add_one(t, 256, LONG, (uint32_t)d->width);
    add_one(t, 257, LONG, (uint32_t)d->height);
    add(t, 258, SHORT, channels, all_bits);
    add_one(t, 259, SHORT, 8);
    add_one(t, 262, SHORT, d->linear ? 34892 : 32803);
    add(t, 273, LONG, count, places);
    add_one(t, 277, SHORT, channels);
    add_one(t, 278, LONG, ROWS);
    add(t, 279, LONG, count, sizes);
    add_one(t, 317, SHORT, d->planes ? 3 : 1);
    add(t, 339, SHORT, channels, of_floats);
    t->size = end;
}

static void put_preview(tiff *t)
{
    const uint32_t bytes = 3 * DNG_PREVIEW_SIDE * DNG_PREVIEW_SIDE;
    add_one(t, 254, LONG, 1);
    add_size(t, DNG_PREVIEW_SIDE, DNG_PREVIEW_SIDE, 8, 3, 2);
    add_one(t, 273, LONG, t->size);
    memset(t->data + t->size, 200, bytes);
    t->size += bytes;
}

void dng_write(const char *path, const dng *d)
{
    tiff t = {
        .data = calloc(1, ROOM + 13 * (size_t)d->width * (size_t)d->height), .size = 8, .big_endian = d->big_endian};
    if (!t.data) abort();
    memcpy(t.data, d->big_endian ? "MM" : "II", 2);
    put(&t, 2, 42, 2);
    put(&t, 4, 8, 4);
    open_folder(&t);
    add_camera(&t, d);
    if (d->preview) {
        put_preview(&t);
        add_one(&t, 330, LONG, t.size);
        open_folder(&t);
    }
    if (!d->floats || !d->linear) add_mosaic_words(&t);
    if (d->floats) {
        if (d->exceeds > 0) add_fractions(&t, 50717, RATIONAL, 1, &d->exceeds);
        put_floats(&t, d);
    } else {
        add_mosaic(&t, d);
        put_codes(&t, d);
    }
    FILE *f = fopen(path, "wb");
    if (!f || fwrite(t.data, 1, t.size, f) != t.size || fclose(f) != 0) abort();
    free(t.data);
}
