/* SPDX-License-Identifier: MIT */
/* exr_write without OpenEXR's library: scan lines, sixteen to a chunk, with the format's ZIP. */
#include <libdeflate.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/half.h"
#include "image/exr/exr.h"

enum { MAGIC = 20000630, VERSION = 2, ZIP = 3, LINES = 16, CHANNELS_MOST = 16, LEVEL = 3, FLOAT = 2, HALF = 1 };

/* A file that is being made. */
typedef struct exr_draft {
    int width, height;
    const exr_channel *channels[CHANNELS_MOST]; /* sorted by name */
    size_t channel_count;
    uint8_t *raw, *changes, *zipped; /* one chunk each */
    struct libdeflate_compressor *packer;
} exr_draft;

/* ---- head ---- */

static void put_int(FILE *f, int32_t number)
{
    fwrite(&number, sizeof number, 1, f); /* WebAssembly is little-endian, as the format */
}

static void put_attribute_head(FILE *f, const char *name, const char *type, size_t size)
{
    fwrite(name, 1, strlen(name) + 1, f);
    fwrite(type, 1, strlen(type) + 1, f);
    put_int(f, (int32_t)size);
}

static void put_floats_of(FILE *f, const char *name, const char *type, const float *values, size_t count)
{
    put_attribute_head(f, name, type, count * sizeof *values);
    fwrite(values, sizeof *values, count, f);
}

static void put_byte_of(FILE *f, const char *name, const char *type, int value)
{
    put_attribute_head(f, name, type, 1);
    fputc(value, f);
}

static void put_window(FILE *f, const char *name, const exr_draft *d)
{
    put_attribute_head(f, name, "box2i", 16);
    put_int(f, 0);
    put_int(f, 0);
    put_int(f, d->width - 1);
    put_int(f, d->height - 1);
}

static void put_channels(FILE *f, const exr_draft *d)
{
    size_t size = 1;
    for (size_t i = 0; i < d->channel_count; i++)
        size += strlen(d->channels[i]->name) + 17;
    put_attribute_head(f, "channels", "chlist", size);
    for (size_t i = 0; i < d->channel_count; i++) {
        fwrite(d->channels[i]->name, 1, strlen(d->channels[i]->name) + 1, f);
        put_int(f, d->channels[i]->full ? FLOAT : HALF);
        put_int(f, 0);
        put_int(f, 1);
        put_int(f, 1);
    }
    fputc(0, f);
}

static void put_given(FILE *f, const exr_attribute *a)
{
    if (a->text) {
        put_attribute_head(f, a->name, "string", strlen(a->text));
        fputs(a->text, f);
    } else {
        put_floats_of(f, a->name, a->count == 1 ? "float" : "floatvector", a->values, (size_t)a->count);
    }
}

static void put_head(FILE *f, const exr_draft *d, const exr_attribute *attributes, size_t count)
{
    const float one = 1, zeros[2] = {0, 0};
    put_int(f, MAGIC);
    put_int(f, VERSION);
    put_channels(f, d);
    put_byte_of(f, "compression", "compression", ZIP);
    put_window(f, "dataWindow", d);
    put_window(f, "displayWindow", d);
    put_byte_of(f, "lineOrder", "lineOrder", 0);
    put_floats_of(f, "pixelAspectRatio", "float", &one, 1);
    put_floats_of(f, "screenWindowCenter", "v2f", zeros, 2);
    put_floats_of(f, "screenWindowWidth", "float", &one, 1);
    for (size_t i = 0; i < count; i++)
        put_given(f, &attributes[i]);
    fputc(0, f);
}

/* ---- pixels ---- */

static uint8_t *put_line(const exr_draft *d, const exr_channel *c, int y, uint8_t *to)
{
    const float *from = c->data + (size_t)y * (size_t)d->width * (size_t)c->stride;
    for (int x = 0; x < d->width; x++, from += c->stride) {
        const float limited = *from > HALF_LARGEST ? HALF_LARGEST : *from < -HALF_LARGEST ? -HALF_LARGEST : *from;
        const uint16_t half = float_to_half(limited);
        const size_t size = c->full ? sizeof *from : sizeof half;
        memcpy(to, c->full ? (const void *)from : &half, size);
        to += size;
    }
    return to;
}

/* Writes a chunk: even bytes before odd ones, differences of successive bytes, then a zlib stream; or its bytes as they
 * are if that is no longer. */
static void put_chunk(FILE *f, const exr_draft *d, int first)
{
    uint8_t *to = d->raw;
    for (int y = first; y < first + LINES && y < d->height; y++)
        for (size_t i = 0; i < d->channel_count; i++)
            to = put_line(d, d->channels[i], y, to);
    const size_t size = (size_t)(to - d->raw), half = (size + 1) / 2;
    uint8_t before = 0;
    for (size_t i = 0; i < size; i++) {
        const uint8_t byte = d->raw[i < half ? 2 * i : 2 * (i - half) + 1];
        d->changes[i] = (uint8_t)(i > 0 ? byte - before + 128 : byte);
        before = byte;
    }
    const size_t zipped = libdeflate_zlib_compress(d->packer, d->changes, size, d->zipped, size - 1);
    put_int(f, first);
    put_int(f, (int32_t)(zipped ? zipped : size));
    fwrite(zipped ? d->zipped : d->raw, 1, zipped ? zipped : size, f);
}

/* ---- the whole ---- */

/* Writes the head, then where each chunk begins, then the chunks: the table is filled in at the end. */
static status put_all(const char *path, const exr_draft *d, const exr_attribute *attributes, size_t count)
{
    char *data = NULL;
    size_t size = 0;
    FILE *f = open_memstream(&data, &size);
    if (!f) return fail(MERLIN_NO_MEMORY, "no memory to write %s", path);
    put_head(f, d, attributes, count);
    const size_t table = (size_t)ftell(f), chunks = (size_t)(d->height + LINES - 1) / LINES;
    uint64_t *places = calloc(chunks, sizeof *places);
    status s = places ? OK : fail(MERLIN_NO_MEMORY, "no memory to write %s", path);
    if (s == OK) fwrite(places, sizeof *places, chunks, f);
    for (size_t i = 0; s == OK && i < chunks; i++) {
        places[i] = (uint64_t)ftell(f);
        put_chunk(f, d, (int)i * LINES);
    }
    if (fclose(f) != 0 && s == OK) s = fail(MERLIN_NO_MEMORY, "no memory to write %s", path);
    if (s == OK) {
        memcpy(data + table, places, chunks * sizeof *places);
        s = file_write(path, data, size);
    }
    free(places);
    free(data);
    return s;
}

static int compare_channels(const void *a, const void *b)
{
    const exr_channel *const *one = a, *const *other = b;
    return strcmp((*one)->name, (*other)->name);
}

status exr_write(const char *path, int width, int height, const exr_channel *channels, size_t channel_count,
                 const exr_attribute *attributes, size_t attribute_count)
{
    if (width < 1 || height < 1 || channel_count < 1 || channel_count > CHANNELS_MOST)
        return fail(MERLIN_WRONG_USE, "an EXR file of %d x %d pixels and %zu channels cannot be", width, height,
                    channel_count);
    exr_draft d = {.width = width, .height = height, .channel_count = channel_count};
    for (size_t i = 0; i < channel_count; i++)
        d.channels[i] = &channels[i];
    qsort(d.channels, channel_count, sizeof *d.channels, compare_channels);
    const size_t room = (size_t)LINES * (size_t)width * channel_count * sizeof(float);
    d.raw = malloc(room);
    d.changes = malloc(room);
    d.zipped = malloc(room);
    d.packer = libdeflate_alloc_compressor(LEVEL);
    status s = d.raw && d.changes && d.zipped && d.packer ? put_all(path, &d, attributes, attribute_count)
                                                          : fail(MERLIN_NO_MEMORY, "no memory to write %s", path);
    free(d.raw);
    free(d.changes);
    free(d.zipped);
    libdeflate_free_compressor(d.packer);
    return s;
}
