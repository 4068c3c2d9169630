/* SPDX-License-Identifier: MIT */
/* Converts a decoder's rows to linear float: each is decoded by its curve, separated into colour and alpha, turned
 * upright, and averaged with its neighbours if the picture is too large to be held. Whatever a file's size, its codes
 * are never held as a whole.
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
    PICTURE_UINT16, /* in the machine's byte order */
    PICTURE_FLOAT,
} picture_sample;

/* The layout of samples in a row. Bands are grey, or RGB, perhaps followed by alpha; further ones are ignored. */
typedef struct picture_layout {
    int width, height; /* size in the file */
    int bands;
    bool alpha;         /* the last band is alpha */
    bool premultiplied; /* colours are multiplied by alpha, before their curve */
    picture_sample sample;
    int orientation;     /* by the EXIF standard; 0 is upright, as 1 */
    float scale;         /* factor for integers and floats; 0 counts as 1 */
    picture_light light; /* meaning of integers; floats are linear, though their primaries may differ ... */
    bool coded;          /* ... except these floats, which have light's curve if one is stated */
} picture_layout;

typedef struct picture_rows picture_rows;

/* Begins a picture. color gets 1 or 3 channels; alpha, which may be NULL, gets 1 if there is one. */
status picture_rows_new(const picture_layout *layout, picture_colour how, img *color, img *alpha, picture_rows **out);
/* Takes a row of the file; each once, in any order. */
void picture_rows_put(picture_rows *rows, int y, const void *samples);
/* Finishes the picture; NULL is allowed. */
void picture_rows_free(picture_rows *rows);

/* Returns how many pixels a side are averaged into one, so that the picture has at most IMAGE_MOST_PIXELS and
 * IMAGE_MAX_SIDE a side: 1 for most. Its size is divided by that and rounded up. */
int picture_reduction(long long width, long long height);
/* Reduces a picture that its decoder returned as a whole; empty ones, and most, are left as they are. */
status picture_reduce(img *image);

#endif
