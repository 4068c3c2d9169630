/* SPDX-License-Identifier: MIT */
/* merlin/image: pictures as floats, from and to files (merlin.h says on which primaries and in which order). */
#ifndef MERLIN_IMAGE_H
#define MERLIN_IMAGE_H

#include <merlin/status.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct merlin_image {
    int width, height, channels;
    float *data; /* height × width × channels; NULL: no image */
} merlin_image;

/* PNG, JPEG, TIFF, WebP, HEIC, GIF, BMP, TGA, netpbm, EXR, Radiance HDR or raw, by content, into 3 linear channels.
 * More than 64 million pixels, or 16384 a side, are read at a reduced size, which merlin_mask_read gives a mask of the
 * same size, too. alpha (may be NULL) gets 1 channel in [0, 1] where the file has one that is not opaque everywhere,
 * else no image. An alpha that nowhere reaches one half shows no object: MERLIN_BAD_INPUT, unless alpha is NULL. */
merlin_status merlin_image_read(const char *path, merlin_image *color, merlin_image *alpha);
/* Coverage, 1 channel in [0, 1]: by the file's alpha unless that is even, else of two values, whatever they are, the
 * greater one, else white on black. Areas of more than two values are MERLIN_BAD_INPUT. */
merlin_status merlin_mask_read(const char *path, merlin_image *mask);
/* 8-bit sRGB PNG, values clamped to [0, 1]; path ends in .png. */
merlin_status merlin_image_write(const char *path, const merlin_image *image);
void merlin_image_free(merlin_image *image);

#ifdef __cplusplus
}
#endif

#endif
