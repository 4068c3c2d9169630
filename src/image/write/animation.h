/* SPDX-License-Identifier: MIT */
/* Animated WebP and GIF, from frames that are added one by one.
 *
 *     img_animation a;
 *     status s = img_animation_new(512, 512, 24, &a);
 *     for (int i = 0; i < 24 && s == OK; i++)
 *         s = img_animation_add(&a, &frame);
 *     if (s == OK) s = img_animation_write(&a, "orbit.webp", 125);
 *     img_animation_free(&a);
 */
#ifndef MERLIN_IMAGE_WRITE_ANIMATION_H
#define MERLIN_IMAGE_WRITE_ANIMATION_H

#include <stdint.h>

#include "image/image.h"

typedef struct img_animation {
    int width, height, count, most;
    uint8_t *codes; /* most × height × width × 3, 8-bit sRGB: a quarter of the frames' size as floats */
} img_animation;

/* Allocates room for `most` frames. */
status img_animation_new(int width, int height, int most, img_animation *a);
/* Adds a copy of 3 linear channels of this size, clamped to [0, 1]. */
status img_animation_add(img_animation *a, const img *frame);
/* Writes the animation in the format of the path's extension, looping forever. */
status img_animation_write(const img_animation *a, const char *path, int milliseconds);
void img_animation_free(img_animation *a);

#endif
