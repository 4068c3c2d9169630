/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/half.h"
#include "image/exr/exr.h"
#include "image/exr/exr_context.h"
#include "image/exr/exr_zip.h"

typedef struct writer {
    const char *path;
    exr_context_t context;
    int width, height;
    const exr_channel *channels;
    size_t channel_count;
    uint16_t *samples; /* one chunk: channel × line × pixel, halves, or floats in two units each */
    size_t chunk_bytes;
    exr_zip zip;
    uint8_t *zipped; /* one chunk */
} writer;

static exr_result_t add_attribute(exr_context_t context, const exr_attribute *a)
{
    if (a->text) return exr_attr_set_string(context, 0, a->name, a->text);
    if (a->count == 1) return exr_attr_set_float(context, 0, a->name, a->values[0]);
    return exr_attr_set_float_vector(context, 0, a->name, a->count, a->values);
}

static exr_pixel_type_t type_of(const exr_channel *c)
{
    return c->full ? EXR_PIXEL_FLOAT : EXR_PIXEL_HALF;
}

static int halves_of(const exr_channel *c)
{
    return c->full ? 2 : 1;
}

static exr_result_t write_head(writer *w, const exr_attribute *attributes, size_t count)
{
    int part = 0;
    exr_result_t r = exr_add_part(w->context, NULL, EXR_STORAGE_SCANLINE, &part);
    if (r == EXR_ERR_SUCCESS)
        r = exr_initialize_required_attr_simple(w->context, part, w->width, w->height, EXR_COMPRESSION_ZIP);
    for (size_t i = 0; r == EXR_ERR_SUCCESS && i < w->channel_count; i++)
        r = exr_add_channel(w->context, part, w->channels[i].name, type_of(&w->channels[i]),
                            EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    for (size_t i = 0; r == EXR_ERR_SUCCESS && i < count; i++)
        r = add_attribute(w->context, &attributes[i]);
    return r == EXR_ERR_SUCCESS ? exr_write_header(w->context) : r;
}

static const exr_channel *find_channel(const writer *w, const char *name)
{
    for (size_t i = 0; i < w->channel_count; i++)
        if (strcmp(w->channels[i].name, name) == 0) return &w->channels[i];
    return NULL;
}

static void line_of_halves(const float *from, int stride, int count, uint16_t *to)
{
    for (int i = 0; i < count; i++) {
        float x = from[(size_t)i * (size_t)stride];
        x = x > HALF_LARGEST ? HALF_LARGEST : x < -HALF_LARGEST ? -HALF_LARGEST : x;
        to[i] = float_to_half(x);
    }
}

static void line_of_floats(const float *from, int stride, int count, uint16_t *to)
{
    for (int i = 0; i < count; i++)
        memcpy(to + 2 * (size_t)i, from + (size_t)i * (size_t)stride, sizeof *from);
}

/* Converts the lines of a chunk and points the encoder's channels (which the library sorts by name) at them. */
static void fill_chunk(const writer *w, exr_encode_pipeline_t *encoder)
{
    int first = encoder->chunk.start_y, lines = encoder->chunk.height;
    uint16_t *to = w->samples;
    for (int c = 0; c < encoder->channel_count; c++) {
        exr_coding_channel_info_t *out = &encoder->channels[c];
        const exr_channel *from = find_channel(w, out->channel_name);
        int halves = halves_of(from), bytes = 2 * halves;
        out->encode_from_ptr = (const uint8_t *)to;
        out->user_bytes_per_element = (int16_t)bytes;
        out->user_data_type = (uint16_t)type_of(from);
        out->user_pixel_stride = bytes;
        out->user_line_stride = bytes * w->width;
        for (int y = first; y < first + lines; y++, to += (size_t)halves * (size_t)w->width) {
            size_t at = (size_t)y * (size_t)w->width * (size_t)from->stride;
            (from->full ? line_of_floats : line_of_halves)(from->data + at, from->stride, w->width, to);
        }
    }
}

static exr_result_t zip_chunk(exr_encode_pipeline_t *encoder)
{
    writer *w = encoder->encoding_user_data;
    if (encoder->packed_bytes > w->chunk_bytes) return EXR_ERR_INVALID_ARGUMENT;
    size_t zipped = 0;
    exr_result_t r = exr_zip_pack(&w->zip, encoder->packed_buffer, encoder->packed_bytes, w->zipped, &zipped);
    encoder->compressed_buffer = w->zipped;
    encoder->compressed_alloc_size = w->chunk_bytes;
    encoder->compressed_bytes = zipped;
    return r;
}

static exr_result_t write_chunks(writer *w, int lines_per_chunk)
{
    exr_encode_pipeline_t encoder = EXR_ENCODE_PIPELINE_INITIALIZER;
    exr_result_t r = EXR_ERR_SUCCESS;
    for (int y = 0; r == EXR_ERR_SUCCESS && y < w->height; y += lines_per_chunk) {
        exr_chunk_info_t chunk;
        r = exr_write_scanline_chunk_info(w->context, 0, y, &chunk);
        if (r != EXR_ERR_SUCCESS) break;
        r = y == 0 ? exr_encoding_initialize(w->context, 0, &chunk, &encoder)
                   : exr_encoding_update(w->context, 0, &chunk, &encoder);
        if (r != EXR_ERR_SUCCESS) break;
        fill_chunk(w, &encoder);
        if (y == 0) r = exr_encoding_choose_default_routines(w->context, 0, &encoder);
        encoder.encoding_user_data = w;
        encoder.compress_fn = zip_chunk;
        if (r == EXR_ERR_SUCCESS) r = exr_encoding_run(w->context, 0, &encoder);
    }
    encoder.compressed_buffer = NULL; /* ours, not the library's to free */
    exr_encoding_destroy(w->context, &encoder);
    return r;
}

static exr_result_t write_pixels(writer *w)
{
    int32_t lines = 0;
    exr_result_t r = exr_get_scanlines_per_chunk(w->context, 0, &lines);
    if (r != EXR_ERR_SUCCESS) return r;
    size_t halves = 0;
    for (size_t i = 0; i < w->channel_count; i++)
        halves += (size_t)halves_of(&w->channels[i]);
    w->chunk_bytes = (size_t)lines * (size_t)w->width * halves * sizeof *w->samples;
    size_t room = w->chunk_bytes > 0 ? w->chunk_bytes : 1;
    w->samples = malloc(room);
    w->zipped = malloc(room);
    r = w->samples && w->zipped ? write_chunks(w, lines) : EXR_ERR_OUT_OF_MEMORY;
    free(w->samples);
    free(w->zipped);
    exr_zip_free(&w->zip);
    return r;
}

static status write_file(writer *w, const char *temporary, const exr_attribute *attributes, size_t count)
{
    exr_context_initializer_t init = exr_quiet();
    exr_result_t r = exr_start_write(&w->context, temporary, EXR_WRITE_FILE_DIRECTLY, &init);
    if (r == EXR_ERR_SUCCESS) {
        exr_set_longname_support(w->context, 1);
        r = write_head(w, attributes, count);
        if (r == EXR_ERR_SUCCESS) r = write_pixels(w);
        exr_result_t closed = exr_finish(&w->context);
        if (r == EXR_ERR_SUCCESS) r = closed;
    }
    return r == EXR_ERR_SUCCESS ? OK : exr_fail(MERLIN_CANNOT_WRITE, "write", w->path, r);
}

/* Checks the channels before the library sees them: when it refuses one it keeps its lock (3.1.5) and never finishes.
 */
static status check_channels(const char *path, const exr_channel *channels, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        size_t length = strlen(channels[i].name);
        if (length < 1 || length > 255)
            return fail(MERLIN_WRONG_USE, "cannot write %s: a channel's name needs 1 to 255 letters", path);
        for (size_t j = 0; j < i; j++)
            if (strcmp(channels[i].name, channels[j].name) == 0)
                return fail(MERLIN_WRONG_USE, "cannot write %s: two channels are called %s", path, channels[i].name);
    }
    return OK;
}

status exr_write(const char *path, int width, int height, const exr_channel *channels, size_t channel_count,
                 const exr_attribute *attributes, size_t attribute_count)
{
    if (width < 1 || height < 1 || channel_count < 1)
        return fail(MERLIN_WRONG_USE, "an EXR file of %d x %d pixels and %zu channels cannot be", width, height,
                    channel_count);
    char *temporary = NULL;
    status s = check_channels(path, channels, channel_count);
    if (s == OK) s = file_temporary(path, &temporary);
    if (s != OK) return s;
    writer w = {.path = path, .width = width, .height = height, .channels = channels, .channel_count = channel_count};
    s = write_file(&w, temporary, attributes, attribute_count);
    if (s != OK) {
        file_discard(temporary);
        return s;
    }
    return file_commit(temporary, path);
}
