/* SPDX-License-Identifier: MIT */
/* Strips and tiles of floats, as TIFF and DNG pack them. */
#ifndef MERLIN_IMAGE_FORMATS_FLOAT_PART_H
#define MERLIN_IMAGE_FORMATS_FLOAT_PART_H

#include <stdbool.h>
#include <stddef.h>

/* A page's pixels in parts, strips or tiles, of floats: deflated or as they are. */
typedef struct float_parts {
    int width, height, samples, bits; /* of the page; a sample's */
    int part_width, part_height;
    int predictor, compression;
    bool big_endian;
} float_parts;

/* Makes the floats of a part from its bytes in the file; false if it is damaged. out: part_width × part_height ×
 * samples; room: as many bytes as they have in the file. */
bool float_part_unpack(const float_parts *p, const void *data, size_t size, void *room, float *out);

#endif
