/* Images to disk. Every file appears whole or not at all. */
#ifndef MERLIN_IMAGE_WRITE_H
#define MERLIN_IMAGE_WRITE_H

#include "image/image.h"

typedef enum img_encoding {
    IMG_SRGB8,   /* linear [0, 1] to 8-bit sRGB: pictures, albedo */
    IMG_LINEAR8, /* [0, 1] to 8 bits as they are: roughness, depth, masks */
    IMG_LINEAR16 /* [0, 1] to 16 bits as they are: normals as (n + 1)/2 */
} img_encoding;

/* 1 or 3 channels; values outside [0, 1] are clamped. */
status img_write_png(const char *path, const img *image, img_encoding encoding);
/* The same of values that are changed on their way, without a copy of the image: `count` pixels from pixel `first` on.
 */
typedef void (*img_change)(const void *context, size_t first, size_t count, float *values);
status img_write_png_changed(const char *path, const img *image, img_encoding encoding, img_change change,
                             const void *context);

float srgb_encode(float linear);
float srgb_decode(float encoded);

#endif
