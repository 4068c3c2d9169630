/* SPDX-License-Identifier: MIT */
#include <string.h>

#include "image/exr/exr_place.h"

status exr_place(const exr_frame *frame, img *image)
{
    long long right = frame->left + image->width, bottom = frame->top + image->height;
    long long first = frame->left > 0 ? frame->left : 0, end = right < frame->width ? right : frame->width;
    img seen;
    status s = img_new(&seen, (int)frame->width, (int)frame->height, image->channels);
    if (s != OK) return s;
    size_t bytes = end > first ? (size_t)(end - first) * (size_t)image->channels * sizeof *image->data : 0;
    for (long long y = frame->top > 0 ? frame->top : 0; bytes && y < bottom && y < frame->height; y++)
        memcpy(img_at(&seen, (int)first, (int)y), img_at(image, (int)(first - frame->left), (int)(y - frame->top)),
               bytes);
    img_free(image);
    *image = seen;
    return OK;
}
