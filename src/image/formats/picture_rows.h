/* SPDX-License-Identifier: MIT */
/* A picture's rows on their way from a decoder to linear float: each is decoded by its curve, parted into colour and
 * alpha, turned upright and, of a picture too large to be held, averaged with its neighbours. Whatever a file's size,
 * its codes are never held as a whole.
 *
 *     picture_rows *rows;
 *     status s = picture_rows_new(&layout, PICTURE_LINEARIZE, &color, &alpha, &rows);
 *     for (int y = 0; s == OK && y < layout.height; y++)
 *         picture_rows_put(rows, y, codes_of_row(y));
 *     picture_rows_free(rows);
 */
#ifndef MERLIN_IMAGE_FORMATS_PICTURE_ROWS_H
#define MERLIN_IMAGE_FORMATS_PICTURE_ROWS_H

#include "image/formats/picture.h"
#include "image/metadata/picture_light.h"

typedef enum picture_sample {
    PICTURE_UINT8,
    PICTURE_UINT16, /* of the machine's order */
    PICTURE_FLOAT,
} picture_sample;

/* The layout of samples in a row. Bands are grey, or RGB, perhaps with alpha behind; further ones are passed over. */
typedef struct picture_layout {
    int width, height; /* in the file */
    int bands;
    bool alpha;         /* the last band is */
    bool premultiplied; /* colours are times it, before their curve */
    picture_sample sample;
    int orientation;     /* by the EXIF standard; 0 is upright, as 1 */
    float scale;         /* what whole numbers and floats are multiplied by; 0 is 1 */
    picture_light light; /* of whole numbers; floats are linear, though their primaries may be others ... */
    bool coded;          /* ... but these, by light's curve where it is said */
} picture_layout;

typedef struct picture_rows picture_rows;

/* color gets 1 or 3 channels, alpha, which may be NULL, 1 if there is any. */
status picture_rows_new(const picture_layout *layout, picture_colour how, img *color, img *alpha, picture_rows **out);
/* Takes a row of the file, each once, in any order. */
void picture_rows_put(picture_rows *rows, int y, const void *samples);
/* Finishes what has been put; NULL is fine. */
void picture_rows_free(picture_rows *rows);

/* Returns how many pixels a side of a picture of this size become one, so that it has at most IMAGE_MOST_PIXELS and
 * IMAGE_MAX_SIDE a side: 1 for most. Its size is then divided by that, rounded up. */
int picture_reduction(long long width, long long height);
/* Reduces a picture that its decoder gave as a whole; empty ones, and most, stay as they are. */
status picture_reduce(img *image);

#endif
