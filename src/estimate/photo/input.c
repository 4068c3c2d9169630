/* SPDX-License-Identifier: MIT */
#include "estimate/photo/input.h"

#include "estimate/surface/surface.h"
#include "image/resize.h"

status input_make(const img *photo, const img *mask, int size, img *picture, img *seen)
{
    *seen = (img){0};
    status s = img_resize_masked(photo, mask, size, size, picture);
    if (s == OK) s = img_resize(mask, size, size, seen);
    if (s == OK) harden_mask(picture, seen);
    return s;
}

void input_expose(img *picture, float gain)
{
    for (size_t i = 0; i < img_value_count(picture); i++)
        picture->data[i] *= gain;
}
