/* SPDX-License-Identifier: MIT */
/* JPEG: what it does to a picture, without a file, and a file's bytes.
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
    bool halved; /* colour at half of the resolution, as cameras and web sites keep it */
} img_jpeg;

/* Compresses rgb (width × height × 3, sRGB) and puts what is left of it back in its place. */
status img_jpeg_round_trip(uint8_t *rgb, int width, int height, const img_jpeg *how);

/* The bytes of a file, malloc'ed: image is linear, of 3 channels, and becomes sRGB, which a JPEG without a profile is
 * in, of quality 95 and with colour at full resolution. Messages call it by name. */
status jpeg_encode(const char *name, const img *image, uint8_t **data, size_t *size);

#endif
