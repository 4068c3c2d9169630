/* What JPEG does to a picture, without a file.
 *
 *     status s = img_jpeg_spoil(pixels, 128, 128, &(img_jpeg){.quality = 75, .halved = true});
 */
#ifndef MERLIN_IMAGE_JPEG_H
#define MERLIN_IMAGE_JPEG_H

#include <stdbool.h>
#include <stdint.h>

#include "base/status.h"

typedef struct img_jpeg {
    int quality; /* 1 to 100 */
    bool halved; /* colour at half of the resolution, as cameras and web sites keep it */
} img_jpeg;

/* Compresses rgb (width × height × 3, sRGB) and puts what is left of it back in its place. */
status img_jpeg_spoil(uint8_t *rgb, int width, int height, const img_jpeg *how);

#endif
