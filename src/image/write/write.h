/* SPDX-License-Identifier: MIT */
/* Writes images to disk. Every file appears as a whole or not at all. */
#ifndef MERLIN_IMAGE_WRITE_WRITE_H
#define MERLIN_IMAGE_WRITE_WRITE_H

#include <stdint.h>

#include "image/image.h"

typedef enum img_encoding {
    IMG_SRGB8,   /* linear [0, 1] to 8-bit sRGB: pictures, albedo */
    IMG_LINEAR8, /* [0, 1] to 8 bits without a curve: roughness, depth, masks */
    IMG_LINEAR16 /* [0, 1] to 16 bits without a curve: normals as (n + 1)/2 */
} img_encoding;

/* Writes 1 or 3 channels; values outside [0, 1] are clamped. */
status img_write_png(const char *path, const img *image, img_encoding encoding);
/* Writes values that a function changes on the way, without a copy of the image: `count` pixels from pixel `first` on.
 */
typedef void (*img_change)(const void *context, size_t first, size_t count, float *values);
status img_write_png_changed(const char *path, const img *image, img_encoding encoding, img_change change,
                             const void *context);

/* Formats of pictures, linear [0, 1] to 8-bit sRGB. */
typedef enum img_file_kind {
    IMG_PNG,
    IMG_JPEG, /* high quality, chroma at full resolution */
} img_file_kind;

/* Encodes a colour picture to a file's bytes, malloc'ed; `name` is used in messages. */
status img_encode_picture(const char *name, const img *image, img_file_kind kind, uint8_t **data, size_t *size);
status img_write_picture(const char *path, const img *image, img_file_kind kind);
/* Writes 1 or 3 channels of [0, 1] as lossless 8-bit codes without a curve. */
status img_write_webp(const char *path, const img *image);

#endif
