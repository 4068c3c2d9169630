/* SPDX-License-Identifier: MIT */
/* Strips and tiles of floats, as TIFF and DNG pack them. */
#ifndef MERLIN_IMAGE_FORMATS_FLOAT_PART_H
#define MERLIN_IMAGE_FORMATS_FLOAT_PART_H

#include <libdeflate.h>
#include <stdbool.h>
#include <stddef.h>

/* Layout of a page's floats in strips or tiles, deflated or uncompressed. */
typedef struct float_parts {
    int width, height, samples, bits; /* size of the page, channels, and bits a sample */
    int part_width, part_height;
    int predictor, compression;
    bool big_endian;
} float_parts;

/* Decodes a part from its bytes in the file; returns false if it is damaged. out: part_width × part_height × samples;
 * room: as many bytes as these samples have in the file. */
bool float_part_unpack(const float_parts *p, struct libdeflate_decompressor *inflater, const void *data, size_t size,
                       void *room, float *out);

#endif
