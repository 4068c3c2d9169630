/* SPDX-License-Identifier: MIT */
/* A canvas of 8-bit sRGB pixels on which figures are drawn: images, words and SVG drawings, written as a PNG. */
#ifndef MERLIN_IMAGE_WRITE_CANVAS_H
#define MERLIN_IMAGE_WRITE_CANVAS_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "image/image.h"

#define CANVAS_GROUND 0x20, 0x21, 0x24 /* dark and neutral, for judging colours */
#define CANVAS_INK 0xe8, 0xea, 0xed
#define CANVAS_INK_CSS "#e8eaed"
#define CANVAS_FONT "DejaVu Sans, sans-serif"

typedef struct canvas {
    int width, height;
    uint8_t *rgb;
} canvas;

/* Makes a canvas filled with the background colour. */
status canvas_new(canvas *out, int width, int height);
void canvas_free(canvas *c);

/* Pastes a linear image of 1 or 3 channels, shown as sRGB, that lies wholly inside the canvas with its top left pixel
 * at (x, y). */
void canvas_paste(canvas *c, const img *image, int x, int y);

/* A text in UTF-8, with the middle of its baseline at (x, y). */
typedef struct canvas_words {
    const char *text;
    int x, y;
} canvas_words;

/* Writes texts with a font of so many pixels. *written is false, and none is written, if the font is not where the
 * build found it or lacks one of their characters: an SVG finds other fonts. */
status canvas_write_words(canvas *c, const canvas_words *words, int count, int size, bool *written);

/* An SVG drawing, to whose stream elements are printed; canvas_draw_end renders it over the canvas. */
typedef struct canvas_drawing {
    FILE *out;
    char *text;
    size_t size;
} canvas_drawing;

status canvas_draw_begin(const canvas *c, canvas_drawing *d);
status canvas_draw_end(canvas *c, canvas_drawing *d);
/* Prints words as an SVG needs them: valid UTF-8, escaped. */
void canvas_print_escaped(canvas_drawing *d, const char *words);

status canvas_write(const canvas *c, const char *path);

#endif
