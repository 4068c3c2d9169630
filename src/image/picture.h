/* Reading, before colour is decoded: a picture as its samples lie in the file, upright, colour and alpha apart. The two
 * sources behind it, libvips and EXR, are read by picture_decode and picture_read_exr. */
#ifndef MERLIN_IMAGE_PICTURE_H
#define MERLIN_IMAGE_PICTURE_H

#include "image/image.h"

/* How colour samples become linear light; alpha is linear always. */
typedef enum picture_colour {
    PICTURE_LINEARIZE, /* integers are sRGB (or by their profile), floats are linear */
    PICTURE_AS_IT_IS,  /* integers are scaled to [0, 1] and nothing else */
} picture_colour;

/* color: 1 or 3 channels; alpha: 1 channel or empty. Either may be NULL. */
status picture_decode(const char *path, picture_colour how, img *color, img *alpha);
/* Bits of a sample, from the file's head alone: 8, 16 or 32. Not for EXR. */
status picture_bits(const char *path, int *bits);
status picture_read_exr(const char *path, img *color, img *alpha);

#endif
