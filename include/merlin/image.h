/* SPDX-License-Identifier: MIT */
/* merlin/image: pictures as floats, from and to files (merlin.h states primaries and order). */
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

/* Reads PNG, JPEG, TIFF, WebP, HEIC, GIF, BMP, TGA, netpbm, EXR, Radiance HDR or raw, by content, into 3 linear
 * channels. More than 64 million pixels, or 16384 a side, are read at a reduced size, as is a mask of that size by
 * merlin_mask_read. alpha (may be NULL) gets 1 channel in [0, 1] if the file has one that is not opaque, else no image.
 * An alpha below one half everywhere shows no object: MERLIN_BAD_INPUT, unless alpha is NULL. */
merlin_status merlin_image_read(const char *path, merlin_image *color, merlin_image *alpha);
/* Reads coverage, 1 channel in [0, 1]: the file's alpha unless that is constant, else the greater of two values,
 * whatever they are, else white on black. Areas of more than two values are MERLIN_BAD_INPUT. */
merlin_status merlin_mask_read(const char *path, merlin_image *mask);
/* Writes 8-bit sRGB, with values clamped to [0, 1]; path ends in .png, or in .jpg (3 channels, high quality).
 * MERLIN_BAD_INPUT for NaN, which has no colour, as from whatever else writes an image. */
merlin_status merlin_image_write(const char *path, const merlin_image *image);
void merlin_image_free(merlin_image *image);

/* ---- pixels in a buffer of the caller ---- */

/* Type of a value: uint8_t, uint16_t in the machine's byte order, or float. */
typedef enum merlin_pixel_type { MERLIN_PIXEL_8, MERLIN_PIXEL_16, MERLIN_PIXEL_FLOAT } merlin_pixel_type;

typedef struct merlin_pixel_layout {
    int width, height;
    int channels;           /* 1: grey; 3: red, green, blue; 4: these and alpha, not premultiplied */
    merlin_pixel_type type; /* integers represent [0, 1]; values need not be aligned */
    int linear;             /* 0: colours are encoded as sRGB; 1: they are linear. Alpha and masks are always linear */
    ptrdiff_t stride;       /* bytes from a row to the next one below it, negative if that precedes it; 0: no gaps */
} merlin_pixel_layout;

/* Copies pixels, the first of which is the upper left one, into 3 linear channels, as merlin_image_read does for a
 * file; alpha (may be NULL) likewise. MERLIN_BAD_INPUT for an alpha that shows no object, MERLIN_WRONG_USE for an
 * impossible layout. */
merlin_status merlin_image_from_pixels(const void *pixels, const merlin_pixel_layout *layout, merlin_image *color,
                                       merlin_image *alpha);
/* Copies pixels of 1 channel into coverage, 0 outside the object and 1 on it. */
merlin_status merlin_mask_from_pixels(const void *pixels, const merlin_pixel_layout *layout, merlin_image *mask);
/* Writes an image of the layout's size into pixels: 1 or 3 channels, where 1 also becomes 3. Integers are clamped and
 * rounded. alpha: 1 channel, if the layout has one; NULL: opaque. */
merlin_status merlin_image_to_pixels(const merlin_image *image, const merlin_image *alpha,
                                     const merlin_pixel_layout *layout, void *pixels);

#ifdef __cplusplus
}
#endif

#endif
