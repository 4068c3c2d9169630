/* SPDX-License-Identifier: MIT */
/* JPEG: the loss of compression applied to pixels, and encoding to a file's bytes.
 *
 *     status s = img_jpeg_round_trip(pixels, 128, 128, &(img_jpeg){.quality = 75, .halved = true});
 */
#ifndef MERLIN_IMAGE_WRITE_JPEG_H
#define MERLIN_IMAGE_WRITE_JPEG_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "image/image.h"

typedef struct img_jpeg {
    int quality; /* 1 to 100 */
    bool halved; /* chroma at half the resolution, as in cameras and on web sites */
} img_jpeg;

/* Compresses rgb (width × height × 3, sRGB) and decompresses it in place. */
status img_jpeg_round_trip(uint8_t *rgb, int width, int height, const img_jpeg *how);

/* Encodes an image to a file's bytes, malloc'ed: image is linear, of 3 channels, and is written as sRGB, the default
 * without a profile, with quality 95 and chroma at full resolution. `name` is used in messages. */
status jpeg_encode(const char *name, const img *image, uint8_t **data, size_t *size);
/* Encodes codes, width × height × 3, likewise, but as they are. */
status jpeg_encode_codes(const char *name, uint8_t *rgb, int width, int height, const img_jpeg *how, uint8_t **data,
                         size_t *size);

#endif
