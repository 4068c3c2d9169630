#include "dng.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BYTE = 1, ASCII = 2, SHORT = 3, LONG = 4, RATIONAL = 5, SIGNED_RATIONAL = 10 };
enum { BLACK = 512, WHITE = 16000, ENTRIES = 32, ROOM = 8192 };

/* A TIFF in the making: folders of entries, then their values, then pixels. */
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

/* values: as many numbers as stand in the file, two for a fraction. */
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

static void add_mosaic(tiff *t, const dng *d)
{
    static const uint32_t period[2] = {2, 2}, pattern[4] = {0, 1, 1, 2};
    add_one(t, 254, LONG, 0);
    add_size(t, (uint32_t)d->width, (uint32_t)d->height, 16, 1, 32803);
    add(t, 33421, SHORT, 2, period);
    add(t, 33422, BYTE, 4, pattern);
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
        .data = calloc(1, ROOM + 2 * (size_t)d->width * (size_t)d->height), .size = 8, .big_endian = d->big_endian};
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
    add_mosaic(&t, d);
    put_codes(&t, d);
    FILE *f = fopen(path, "wb");
    if (!f || fwrite(t.data, 1, t.size, f) != t.size || fclose(f) != 0) abort();
    free(t.data);
}
