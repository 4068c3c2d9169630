/* SPDX-License-Identifier: MIT */
/* merlin/pictures: pictures for people: files of several formats, contact sheets, animations.
 *
 *     merlin_animation *orbit;
 *     if (merlin_animation_new(256, 256, 24, &orbit)) ...
 *     for (int i = 0; i < 24; i++) merlin_animation_add(orbit, &frame[i]);
 *     merlin_animation_write(orbit, "orbit.webp", 125);
 *     merlin_animation_free(orbit);
 *
 * Images are linear and written as sRGB, with values clamped to [0, 1]. A file is written completely or, after a
 * failure, not at all. */
#ifndef MERLIN_PICTURES_H
#define MERLIN_PICTURES_H

#include <merlin/image.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Resizes by Lanczos to enlarge, by area to shrink. */
merlin_status merlin_image_resize(const merlin_image *image, int width, int height, merlin_image *out);

/* ---- file formats besides those of merlin_image_write ---- */

typedef enum merlin_image_format {
    MERLIN_PNG,
    MERLIN_JPEG, /* high quality, colour at full resolution */
} merlin_image_format;

/* Encodes an image of 3 channels as the bytes of a file of 8-bit sRGB, as merlin_image_write writes them. Release them
 * with free. */
merlin_status merlin_image_encode(const merlin_image *image, merlin_image_format format, unsigned char **bytes,
                                  size_t *size);
/* Writes a mask, or another image of 1 or 3 channels in [0, 1] that is not a picture, as linear 8-bit values,
 * losslessly: path ends in .png or .webp. */
merlin_status merlin_mask_write(const merlin_image *mask, const char *path);

/* ---- sheets ---- */

typedef struct merlin_tile {
    const char *label;           /* text below it, in UTF-8 */
    const merlin_image *picture; /* 1 or 3 channels, resized to the tile's size */
} merlin_tile;

/* Writes count tiles in rows of `columns`, each side x side pixels, on dark grey, as a PNG. */
merlin_status merlin_sheet_write(const merlin_tile *tiles, int count, int columns, int side, const char *path);

/* ---- animations ---- */

typedef struct merlin_animation merlin_animation;

/* Makes an animation without frames and with room for `most`. */
merlin_status merlin_animation_new(int width, int height, int most, merlin_animation **out);
/* Adds a frame of that size, 3 channels, which is copied. */
merlin_status merlin_animation_add(merlin_animation *animation, const merlin_image *frame);
/* Writes the animation, repeated endlessly, each frame for so many milliseconds: path ends in .webp or .gif. */
merlin_status merlin_animation_write(const merlin_animation *animation, const char *path, int milliseconds);
void merlin_animation_free(merlin_animation *animation);

#ifdef __cplusplus
}
#endif

#endif
