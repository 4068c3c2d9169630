/* SPDX-License-Identifier: MIT */
/* merlin/pictures: pictures for people to look at: files of several formats, sheets of many, animations.
 *
 *     merlin_animation *orbit;
 *     if (merlin_animation_new(256, 256, 24, &orbit)) ...
 *     for (int i = 0; i < 24; i++) merlin_animation_add(orbit, &frame[i]);
 *     merlin_animation_write(orbit, "orbit.webp", 125);
 *     merlin_animation_free(orbit);
 *
 * Images are linear and shown as sRGB, their values clamped to [0, 1]. A file appears as a whole or, after a failure,
 * not at all. */
#ifndef MERLIN_PICTURES_H
#define MERLIN_PICTURES_H

#include <merlin/image.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Resizes by Lanczos where it enlarges, by area where it shrinks. */
merlin_status merlin_image_resize(const merlin_image *image, int width, int height, merlin_image *out);

/* ---- files beside those of merlin_image_write ---- */

typedef enum merlin_image_format {
    MERLIN_PNG,
    MERLIN_JPEG, /* of high quality, colour at full resolution */
} merlin_image_format;

/* Makes the bytes of a file of 8-bit sRGB, as merlin_image_write writes them, of 3 channels. They are yours to give to
 * free. */
merlin_status merlin_image_encode(const merlin_image *image, merlin_image_format format, unsigned char **bytes,
                                  size_t *size);
/* Writes a mask, or another image of 1 or 3 channels in [0, 1] that is no picture, as 8-bit values without the curve of
 * sRGB, which loses nothing else: path ends in .png or .webp. */
merlin_status merlin_mask_write(const merlin_image *mask, const char *path);

/* ---- sheets ---- */

typedef struct merlin_tile {
    const char *label;           /* below it, in UTF-8 */
    const merlin_image *picture; /* 1 or 3 channels, brought to the tile's size */
} merlin_tile;

/* Writes count tiles in rows of so many, each side x side pixels, on dark grey, as a PNG. */
merlin_status merlin_sheet_write(const merlin_tile *tiles, int count, int columns, int side, const char *path);

/* ---- animations ---- */

typedef struct merlin_animation merlin_animation;

/* Makes one without frames yet and with room for `most`. */
merlin_status merlin_animation_new(int width, int height, int most, merlin_animation **out);
/* Adds a frame of that size, 3 channels, of which a copy is kept. */
merlin_status merlin_animation_add(merlin_animation *animation, const merlin_image *frame);
/* Writes it, to be repeated for ever, each frame shown for so many milliseconds: path ends in .webp or .gif. */
merlin_status merlin_animation_write(const merlin_animation *animation, const char *path, int milliseconds);
void merlin_animation_free(merlin_animation *animation);

#ifdef __cplusplus
}
#endif

#endif
