/* SPDX-License-Identifier: MIT */
/* Functions shared by the readers of .mat and .npz: numbers from bytes, checks of sizes, zlib. */
#ifndef MERLIN_STEREO_ARRAYS_ARRAY_PARTS_H
#define MERLIN_STEREO_ARRAYS_ARRAY_PARTS_H

#include <stdint.h>

#include "stereo/arrays/array_file.h"

/* Largest array in bytes, more than any picture's normals; a damaged size beyond it is refused before memory is
 * allocated. */
#define ARRAY_MOST_BYTES ((size_t)1 << 30)

typedef enum number_kind { NUMBER_FLOAT, NUMBER_SIGNED, NUMBER_UNSIGNED } number_kind;

typedef struct number_type {
    number_kind kind;
    size_t bytes; /* 1, 2, 4 or 8; floats 2, 4 or 8 */
} number_type;

static inline uint32_t little16(const unsigned char *p)
{
    return (uint32_t)p[0] | (uint32_t)p[1] << 8;
}

static inline uint32_t little32(const unsigned char *p)
{
    return little16(p) | little16(p + 2) << 16;
}

/* Sets a->size from `rank` sizes; refuses none, more than three (except trailing ones) and too many numbers. */
status array_shape(number_array *a, const uint64_t *size, size_t rank, const char *where);
/* Fills a->data with little-endian numbers; `available` bytes must contain all of them. */
status array_fill(number_array *a, const unsigned char *bytes, size_t available, number_type type, const char *where);

/* Inflates until `wanted` bytes are there; window_bits as in zlib. Returns false if the data are damaged or too short.
 */
bool array_inflate(const unsigned char *from, size_t size, int window_bits, unsigned char *out, size_t wanted);

/* A parser of array_file.h: reads the array of this name from bytes. */
typedef status array_parser(const char *bytes, size_t size, const char *where, const char *name, number_array *out);
/* Reads the array of this name from a file by its parser. */
status array_read(array_parser *parse, const char *path, const char *name, number_array *out);

#endif
