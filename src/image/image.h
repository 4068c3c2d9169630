/* Float images, interleaved, rows from the top, linear sRGB primaries unless a name says otherwise. */
#ifndef MERLIN_IMAGE_IMAGE_H
#define MERLIN_IMAGE_IMAGE_H

#include <stddef.h>

#include "base/status.h"

typedef struct img {
    int width, height, channels;
    float *data; /* height × width × channels */
} img;

/* Zero-filled. Refuses sizes below 1 or beyond memory. img_free leaves an empty image; freeing one is fine. */
status img_new(img *out, int width, int height, int channels);
void img_free(img *image);
status img_copy(img *out, const img *from);

static inline float *img_at(const img *image, int x, int y)
{
    return image->data + ((size_t)y * (size_t)image->width + (size_t)x) * (size_t)image->channels;
}

#endif
