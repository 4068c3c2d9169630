/* SPDX-License-Identifier: MIT */
#include "stereo/arrays/array_parts.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "base/file.h"
#include "base/half.h"

void array_free(number_array *a)
{
    free(a->data);
    *a = (number_array){0};
}

status array_shape(number_array *a, const uint64_t *size, size_t rank, const char *where)
{
    uint64_t count = 1;
    for (size_t i = 0; i < ARRAY_MOST_DIMENSIONS; i++)
        a->size[i] = 1;
    for (size_t i = 0; i < rank; i++) {
        if (size[i] == 0) return fail(MERLIN_BAD_INPUT, "%s: the array is empty", where);
        if (size[i] > ARRAY_MOST_BYTES / 8 || (count *= size[i]) > ARRAY_MOST_BYTES / 8)
            return fail(MERLIN_BAD_INPUT, "%s: the array is too large, or the file is damaged", where);
        if (i < ARRAY_MOST_DIMENSIONS)
            a->size[i] = (size_t)size[i];
        else if (size[i] != 1)
            return fail(MERLIN_BAD_INPUT, "%s: the array has more than %d dimensions", where, ARRAY_MOST_DIMENSIONS);
    }
    return OK;
}

static float read_float(const unsigned char *p, size_t bytes)
{
    if (bytes == 2) return half_to_float((uint16_t)little16(p));
    if (bytes == 4) return bits_float(little32(p));
    uint64_t bits = (uint64_t)little32(p) | (uint64_t)little32(p + 4) << 32;
    double value;
    memcpy(&value, &bits, sizeof value);
    return fabs(value) <= 3.4e38 ? (float)value : NAN;
}

static float read_number(const unsigned char *p, number_type type)
{
    if (type.kind == NUMBER_FLOAT) return read_float(p, type.bytes);
    uint64_t bits = 0;
    for (size_t i = 0; i < type.bytes; i++)
        bits |= (uint64_t)p[i] << (8 * i);
    if (type.kind == NUMBER_UNSIGNED) return (float)bits;
    unsigned unused = (unsigned)(64 - 8 * type.bytes);
    return (float)((int64_t)(bits << unused) >> unused);
}

status array_fill(number_array *a, const unsigned char *bytes, size_t available, number_type type, const char *where)
{
    size_t count = array_count(a);
    if (available / type.bytes < count)
        return fail(MERLIN_BAD_INPUT, "%s: the file ends before its %zu numbers do; it is damaged", where, count);
    a->data = malloc(count * sizeof *a->data);
    if (!a->data) return fail(MERLIN_NO_MEMORY, "no memory for the %zu numbers of %s", count, where);
    for (size_t i = 0; i < count; i++)
        a->data[i] = read_number(bytes + i * type.bytes, type);
    return OK;
}

bool array_inflate(const unsigned char *from, size_t size, int window_bits, unsigned char *out, size_t wanted)
{
    z_stream z = {.next_in = (unsigned char *)from};
    if (size > UINT_MAX || wanted > UINT_MAX || inflateInit2(&z, window_bits) != Z_OK) return false;
    z.avail_in = (uInt)size;
    z.next_out = out;
    z.avail_out = (uInt)wanted;
    inflate(&z, Z_SYNC_FLUSH);
    bool whole = z.avail_out == 0;
    inflateEnd(&z);
    return whole;
}

status array_read(array_parser *parse, const char *path, const char *name, number_array *out)
{
    *out = (number_array){0};
    char *bytes;
    size_t size;
    status s = file_read(path, ARRAY_MOST_BYTES, &bytes, &size);
    if (s != OK) return s;
    s = parse(bytes, size, path, name, out);
    free(bytes);
    return s;
}
