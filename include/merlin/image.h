/* SPDX-License-Identifier: MIT */
/* merlin/image: pictures as floats, from and to files (merlin.h says on which primaries and in which order). */
#ifndef MERLIN_IMAGE_H
#define MERLIN_IMAGE_H

#include <merlin/status.h>
#include <stddef.h>

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
/* 8-bit sRGB, values clamped to [0, 1]; path ends in .png, or in .jpg (3 channels, of high quality). */
merlin_status merlin_image_write(const char *path, const merlin_image *image);
void merlin_image_free(merlin_image *image);

/* ---- pixels in a buffer of yours ---- */

/* The type of a value: uint8_t, uint16_t in the machine's byte order, or float. */
typedef enum merlin_pixel_type { MERLIN_PIXEL_8, MERLIN_PIXEL_16, MERLIN_PIXEL_FLOAT } merlin_pixel_type;

typedef struct merlin_pixel_layout {
    int width, height;
    int channels;           /* 1: grey; 3: red, green, blue; 4: these and alpha, which is not multiplied into them */
    merlin_pixel_type type; /* whole numbers stand for [0, 1]; no value needs to be aligned */
    int linear;       /* 0: colours are encoded as sRGB; 1: they are linear. Alpha and masks are linear in any case */
    ptrdiff_t stride; /* bytes from a row to the one below it, below 0 where that lies before it; 0: without gaps */
} merlin_pixel_layout;

/* Copies pixels, the first being the upper left one, into 3 linear channels, as merlin_image_read does a file's; alpha
 * (may be NULL) likewise. MERLIN_BAD_INPUT for an alpha that shows no object, MERLIN_WRONG_USE for a layout that cannot
 * be. */
merlin_status merlin_image_from_pixels(const void *pixels, const merlin_pixel_layout *layout, merlin_image *color,
                                       merlin_image *alpha);
/* Copies pixels of 1 channel into coverage, 0 beside the object and 1 on it. */
merlin_status merlin_mask_from_pixels(const void *pixels, const merlin_pixel_layout *layout, merlin_image *mask);
/* Writes an image of the layout's size into pixels: 1 or 3 channels, of which 1 also becomes 3. Whole numbers are
 * clamped and rounded. alpha: 1 channel, where the layout has one; NULL: opaque. */
merlin_status merlin_image_to_pixels(const merlin_image *image, const merlin_image *alpha,
                                     const merlin_pixel_layout *layout, void *pixels);

#ifdef __cplusplus
}
#endif

#endif
