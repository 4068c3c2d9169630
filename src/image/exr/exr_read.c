/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/file.h"
#include "base/half.h"
#include "image/exr/exr.h"
#include "image/exr/exr_context.h"
#include "image/exr/exr_zip.h"
#include "image/metadata/picture_size.h"

struct exr_file {
    char *path;
    exr_context_t context;
    int part, parts; /* the current part, which the fields below describe, and the number of parts */
    exr_attr_box2i_t window, display;
    const exr_attr_chlist_t *channels;
    exr_storage_t storage;
    exr_compression_t compression;
};

/* Where a requested channel lies in a line of a chunk: bytes per pixel of the channels before it. */
typedef struct source {
    size_t bytes_before;
    exr_pixel_type_t type;
} source;

static status fail_reading(const exr_file *f, exr_result_t code)
{
    if (code == EXR_ERR_FEATURE_NOT_IMPLEMENTED) /* DWAA and DWAB, in OpenEXR 3.1.5 */
        return fail(MERLIN_BAD_INPUT,
                    "cannot read %s: the OpenEXR installed here does not know its compression; save it with ZIP or PIZ",
                    f->path);
    return exr_fail(MERLIN_BAD_INPUT, "read", f->path, code);
}

static size_t channel_bytes(const exr_attr_chlist_entry_t *c)
{
    return c->pixel_type == EXR_PIXEL_HALF ? 2 : 4;
}

static status check_layout(const exr_file *f)
{
    long long width = 1LL + f->window.max.x - f->window.min.x, height = 1LL + f->window.max.y - f->window.min.y;
    if (width > IMAGE_MAX_SIDE || height > IMAGE_MAX_SIDE)
        return fail(MERLIN_BAD_INPUT,
                    "cannot read %s: it is %lld x %lld pixels, more than %d a side; make it smaller first", f->path,
                    width, height, IMAGE_MAX_SIDE);
    if (f->storage != EXR_STORAGE_SCANLINE && f->storage != EXR_STORAGE_TILED)
        return fail(MERLIN_BAD_INPUT, "cannot read %s: deep EXR files are not supported, flatten it first", f->path);
    for (int i = 0; i < f->channels->num_channels; i++)
        if (f->channels->entries[i].x_sampling != 1 || f->channels->entries[i].y_sampling != 1)
            return fail(MERLIN_BAD_INPUT,
                        "cannot read %s: its channel %s is subsampled, which is not supported; save it as RGB", f->path,
                        f->channels->entries[i].name.str);
    return OK;
}

static status open_part(exr_file *f)
{
    exr_result_t r = exr_get_storage(f->context, f->part, &f->storage);
    if (r == EXR_ERR_SUCCESS) r = exr_get_compression(f->context, f->part, &f->compression);
    if (r == EXR_ERR_SUCCESS) r = exr_get_data_window(f->context, f->part, &f->window);
    if (r == EXR_ERR_SUCCESS) r = exr_get_display_window(f->context, f->part, &f->display);
    if (r == EXR_ERR_SUCCESS) r = exr_get_channels(f->context, f->part, &f->channels);
    return r == EXR_ERR_SUCCESS ? check_layout(f) : fail_reading(f, r);
}

static status open_file(exr_file *f)
{
    status s = file_check_plain(f->path);
    if (s != OK) return s;
    exr_context_initializer_t init = exr_quiet();
    exr_result_t r = exr_start_read(&f->context, f->path, &init);
    /* OpenEXR goes on without attributes that it had no memory for */
    if (r == EXR_ERR_SUCCESS && status_by_errno(OK) != OK) r = EXR_ERR_OUT_OF_MEMORY;
    /* an unknown method: OpenEXR reports it and then assumes ZIP */
    if (r == EXR_ERR_SUCCESS && exr_complained_of("'compression'")) r = EXR_ERR_FEATURE_NOT_IMPLEMENTED;
    if (r == EXR_ERR_SUCCESS) exr_forget_complaint();
    if (r == EXR_ERR_SUCCESS) r = exr_get_count(f->context, &f->parts);
    return r == EXR_ERR_SUCCESS ? open_part(f) : fail_reading(f, r);
}

status exr_open(const char *path, exr_file **out)
{
    *out = NULL;
    exr_file *f = calloc(1, sizeof *f);
    if (f) f->path = strdup(path);
    if (!f || !f->path) {
        free(f);
        return fail(MERLIN_NO_MEMORY, "no memory to read %s", path);
    }
    status s = open_file(f);
    if (s != OK) {
        exr_close(f);
        return s;
    }
    *out = f;
    return OK;
}

status exr_next_part(exr_file *f, bool *found)
{
    *found = f->part + 1 < f->parts;
    if (!*found) return OK;
    f->part++;
    return open_part(f);
}

void exr_close(exr_file *f)
{
    if (!f) return;
    if (f->context) exr_finish(&f->context);
    free(f->path);
    free(f);
}

int exr_width(const exr_file *f)
{
    return f->window.max.x - f->window.min.x + 1;
}

int exr_height(const exr_file *f)
{
    return f->window.max.y - f->window.min.y + 1;
}

exr_frame exr_display(const exr_file *f)
{
    const exr_attr_box2i_t *d = &f->display, *w = &f->window;
    return (exr_frame){.width = 1LL + d->max.x - d->min.x,
                       .height = 1LL + d->max.y - d->min.y,
                       .left = (long long)w->min.x - d->min.x,
                       .top = (long long)w->min.y - d->min.y};
}

static bool find_source(const exr_file *f, const char *name, source *out)
{
    size_t before = 0;
    for (int i = 0; i < f->channels->num_channels; i++) {
        const exr_attr_chlist_entry_t *c = &f->channels->entries[i];
        if (strcmp(c->name.str, name) == 0) {
            *out = (source){before, c->pixel_type};
            return true;
        }
        before += channel_bytes(c);
    }
    return false;
}

bool exr_has_channel(const exr_file *f, const char *name)
{
    source ignored;
    return find_source(f, name, &ignored);
}

const char *exr_channel_name(const exr_file *f, int index)
{
    return index >= 0 && index < f->channels->num_channels ? f->channels->entries[index].name.str : NULL;
}

static void convert_values(const uint8_t *from, exr_pixel_type_t type, int first, int end, float *to, int stride)
{
    if (type == EXR_PIXEL_HALF) {
        for (int i = first; i < end; i++) {
            uint16_t half;
            memcpy(&half, from + 2 * (size_t)i, sizeof half);
            to[(size_t)i * (size_t)stride] = half_to_float(half);
        }
        return;
    }
    for (int i = first; i < end; i++) {
        uint32_t bits;
        memcpy(&bits, from + 4 * (size_t)i, sizeof bits);
        to[(size_t)i * (size_t)stride] = type == EXR_PIXEL_FLOAT ? bits_float(bits) : (float)bits;
    }
}

static void clear_values(int first, int end, float *to, int stride)
{
    for (int i = first; i < end; i++)
        if (to[(size_t)i * (size_t)stride] != 0) to[(size_t)i * (size_t)stride] = 0;
}

/* Converts a line. Zeros are not written where the target is already zero, so that untouched pages stay unallocated
 * (image.h). */
static void convert_line(const uint8_t *from, exr_pixel_type_t type, int count, float *to, int stride)
{
    size_t bytes = type == EXR_PIXEL_HALF ? 2 : 4, first = 0, end = (size_t)count * bytes;
    while (end > 0 && from[end - 1] == 0)
        end--;
    while (first < end && from[first] == 0)
        first++;
    int begin = (int)(first / bytes), stop = (int)((end + bytes - 1) / bytes);
    clear_values(0, begin, to, stride);
    convert_values(from, type, begin, stop, to, stride);
    clear_values(stop, count, to, stride);
}

typedef struct reader {
    exr_file *file;
    const exr_target *targets;
    const source *sources;
    size_t count, pixel_bytes;
    exr_decode_pipeline_t decoder;
    exr_result_t (*decompress)(exr_decode_pipeline_t *decoder);
    exr_zip zip;
    bool started;
} reader;

static exr_result_t unzip_chunk(exr_decode_pipeline_t *d)
{
    if (!d->unpacked_buffer || d->chunk.unpacked_size > d->unpacked_alloc_size || d->chunk.unpacked_size < 2)
        return EXR_ERR_CORRUPT_CHUNK;
    return exr_zip_unpack(d->decoding_user_data, d->packed_buffer, d->chunk.packed_size, d->unpacked_buffer,
                          d->chunk.unpacked_size);
}

/* Prepares the decoder for a chunk: the library reads and, but for ZIP, decompresses; unpacking is done here. */
static exr_result_t aim_decoder(reader *r, const exr_chunk_info_t *chunk)
{
    exr_context_t context = r->file->context;
    if (r->started) return exr_decoding_update(context, r->file->part, chunk, &r->decoder);
    r->started = true;
    exr_result_t code = exr_decoding_initialize(context, r->file->part, chunk, &r->decoder);
    if (code == EXR_ERR_SUCCESS) code = exr_decoding_choose_default_routines(context, r->file->part, &r->decoder);
    r->decoder.unpack_and_convert_fn = NULL;
    r->decoder.decoding_user_data = &r->zip;
    const exr_compression_t by = r->file->compression;
    r->decompress = by == EXR_COMPRESSION_ZIP || by == EXR_COMPRESSION_ZIPS ? unzip_chunk : r->decoder.decompress_fn;
    return code;
}

/* Decodes one chunk and copies the requested channels to their targets; x, y: its first pixel in the image. */
static exr_result_t read_chunk(reader *r, const exr_chunk_info_t *chunk, int x, int y)
{
    exr_decode_pipeline_t *d = &r->decoder;
    exr_result_t code = aim_decoder(r, chunk);
    /* a chunk that compression did not shrink is stored raw, which OpenEXR 3.1.5 decompresses all the same in B44 files
     */
    bool as_it_was = chunk->packed_size == chunk->unpacked_size;
    d->decompress_fn = as_it_was ? NULL : r->decompress;
    if (code == EXR_ERR_SUCCESS) code = exr_decoding_run(r->file->context, r->file->part, d);
    if (code != EXR_ERR_SUCCESS) return code;
    const uint8_t *bytes = as_it_was ? d->packed_buffer : d->unpacked_buffer;
    size_t width = (size_t)chunk->width, line_bytes = width * r->pixel_bytes;
    if (!bytes || chunk->unpacked_size != line_bytes * (size_t)chunk->height) return EXR_ERR_CORRUPT_CHUNK;
    for (size_t t = 0; t < r->count; t++) {
        const exr_target *target = &r->targets[t];
        for (int row = 0; row < chunk->height; row++) {
            const uint8_t *from = bytes + (size_t)row * line_bytes + width * r->sources[t].bytes_before;
            size_t pixel = (size_t)(y + row) * (size_t)exr_width(r->file) + (size_t)x;
            convert_line(from, r->sources[t].type, chunk->width, target->data + pixel * (size_t)target->stride,
                         target->stride);
        }
    }
    return EXR_ERR_SUCCESS;
}

static exr_result_t read_scanlines(reader *r)
{
    const exr_file *f = r->file;
    int32_t lines = 0;
    exr_result_t code = exr_get_scanlines_per_chunk(f->context, f->part, &lines);
    for (int y = 0; code == EXR_ERR_SUCCESS && y < exr_height(f); y += lines) {
        exr_chunk_info_t chunk;
        code = exr_read_scanline_chunk_info(f->context, f->part, f->window.min.y + y, &chunk);
        if (code == EXR_ERR_SUCCESS && (chunk.width != exr_width(f) || chunk.height > exr_height(f) - y))
            code = EXR_ERR_CORRUPT_CHUNK;
        if (code == EXR_ERR_SUCCESS) code = read_chunk(r, &chunk, 0, y);
    }
    return code;
}

static exr_result_t read_tiles(reader *r)
{
    const exr_file *f = r->file;
    int32_t width = 0, height = 0;
    exr_result_t code = exr_get_tile_sizes(f->context, f->part, 0, 0, &width, &height);
    if (code == EXR_ERR_SUCCESS && (width < 1 || height < 1)) code = EXR_ERR_CORRUPT_CHUNK;
    for (int y = 0; code == EXR_ERR_SUCCESS && y < exr_height(f); y += height) {
        for (int x = 0; code == EXR_ERR_SUCCESS && x < exr_width(f); x += width) {
            exr_chunk_info_t chunk;
            code = exr_read_tile_chunk_info(f->context, f->part, x / width, y / height, 0, 0, &chunk);
            if (code == EXR_ERR_SUCCESS && (chunk.width > exr_width(f) - x || chunk.height > exr_height(f) - y))
                code = EXR_ERR_CORRUPT_CHUNK;
            if (code == EXR_ERR_SUCCESS) code = read_chunk(r, &chunk, x, y);
        }
    }
    return code;
}

/* Refuses small files that expand to too much memory: pixels that are nearly all empty. */
static status check_density(const exr_file *f, size_t channels)
{
    const double harmless = 512 * 0x1p20, densest = 256;         /* bytes always allowed, and per byte of the file */
    size_t with_colour = channels < 3 ? channels + 3 : channels; /* grey may be requested as colour */
    double bytes = (double)(with_colour * sizeof(float)) * exr_width(f) * exr_height(f);
    struct stat about;
    if (bytes <= harmless || stat(f->path, &about) != 0 || bytes <= densest * (double)about.st_size) return OK;
    return fail(MERLIN_BAD_INPUT,
                "cannot read %s: its %d x %d pixels would take %.0f MB of memory, and the file has %.1f MB of content; "
                "crop it to what it shows",
                f->path, exr_width(f), exr_height(f), bytes / 0x1p20, (double)about.st_size / 0x1p20);
}

status exr_read(exr_file *f, const exr_target *targets, size_t count)
{
    status s = check_density(f, count);
    if (s != OK) return s;
    exr_forget_complaint();
    source *sources = calloc(count + 1, sizeof *sources);
    if (!sources) return fail(MERLIN_NO_MEMORY, "no memory to read %s", f->path);
    for (size_t i = 0; i < count; i++) {
        if (find_source(f, targets[i].name, &sources[i])) continue;
        free(sources);
        return fail(MERLIN_BAD_INPUT, "cannot read %s: it has no channel %s", f->path, targets[i].name);
    }
    reader r = {.file = f, .targets = targets, .sources = sources, .count = count};
    for (int i = 0; i < f->channels->num_channels; i++)
        r.pixel_bytes += channel_bytes(&f->channels->entries[i]);
    exr_result_t code = f->storage == EXR_STORAGE_TILED ? read_tiles(&r) : read_scanlines(&r);
    if (r.started) exr_decoding_destroy(f->context, &r.decoder);
    exr_zip_free(&r.zip);
    free(sources);
    return code == EXR_ERR_SUCCESS ? OK : fail_reading(f, code);
}

bool exr_has_attribute(const exr_file *f, const char *name)
{
    const exr_attribute_t *ignored = NULL;
    return exr_get_attribute_by_name(f->context, f->part, name, &ignored) == EXR_ERR_SUCCESS;
}

bool exr_get_numbers(const exr_file *f, const char *name, float *values, int count)
{
    const exr_attribute_t *a = NULL;
    if (exr_get_attribute_by_name(f->context, f->part, name, &a) != EXR_ERR_SUCCESS) return false;
    bool one = a->type == EXR_ATTR_FLOAT && count == 1;
    if (!one && (a->type != EXR_ATTR_FLOAT_VECTOR || a->floatvector->length != count)) return false;
    const float *found = one ? &a->f : a->floatvector->arr;
    for (int i = 0; i < count; i++)
        if (!isfinite(found[i])) return false;
    memcpy(values, found, (size_t)count * sizeof *values);
    return true;
}

bool exr_get_chromaticities(const exr_file *f, float xy[8])
{
    exr_attr_chromaticities_t c;
    if (exr_attr_get_chromaticities(f->context, f->part, "chromaticities", &c) != EXR_ERR_SUCCESS) return false;
    const float found[8] = {c.red_x, c.red_y, c.green_x, c.green_y, c.blue_x, c.blue_y, c.white_x, c.white_y};
    memcpy(xy, found, sizeof found);
    return true;
}

const char *exr_get_text(const exr_file *f, const char *name)
{
    const exr_attribute_t *a = NULL;
    if (exr_get_attribute_by_name(f->context, f->part, name, &a) != EXR_ERR_SUCCESS) return NULL;
    return a->type == EXR_ATTR_STRING ? a->string->str : NULL;
}
