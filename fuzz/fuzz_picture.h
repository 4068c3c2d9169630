/* SPDX-License-Identifier: MIT */
/* Pictures of one kind from arbitrary bytes: whatever is accepted must be finite, of three channels, of the size that
 * its head says, and a mask within [0, 1]. */
#ifndef MERLIN_FUZZ_PICTURE_H
#define MERLIN_FUZZ_PICTURE_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fuzz_file.h"
#include "image/read/read.h"

static inline void fuzz_check_values(const img *image, float low, float high)
{
    for (size_t i = 0; i < img_value_count(image); i++)
        if (!isfinite(image->data[i]) || image->data[i] < low || image->data[i] > high) abort();
}

static inline void fuzz_picture(const char *path)
{
    img color = {0}, alpha = {0}, mask = {0};
    int width, height;
    if (img_read_size(path, &width, &height) == OK && (width < 1 || height < 1)) abort();
    if (img_read(path, &color, &alpha) == OK) {
        if (color.channels != 3) abort();
        fuzz_check_values(&color, -INFINITY, INFINITY);
        if (alpha.data) fuzz_check_values(&alpha, 0, 1);
        img_free(&color);
        img_free(&alpha);
        if (img_read_mask(path, &mask) == OK) fuzz_check_values(&mask, 0, 1);
        img_free(&mask);
    }
    if (strchr(status_message(), '\n')) abort();
}

#endif
