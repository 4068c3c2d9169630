/* SPDX-License-Identifier: MIT */
/* A canvas of 8-bit sRGB pixels that takes pictures, words and SVG drawings (text, lines) and ends as a PNG; what
 * figures are made of. */
#ifndef MERLIN_IMAGE_WRITE_CANVAS_H
#define MERLIN_IMAGE_WRITE_CANVAS_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "image/image.h"

#define CANVAS_GROUND 0x20, 0x21, 0x24 /* dark and neutral, so that colours are judged rightly */
#define CANVAS_INK 0xe8, 0xea, 0xed
#define CANVAS_INK_CSS "#e8eaed"
#define CANVAS_FONT "DejaVu Sans, sans-serif"

typedef struct canvas {
    int width, height;
    uint8_t *rgb;
} canvas;

/* Filled with the ground colour. */
status canvas_new(canvas *out, int width, int height);
void canvas_free(canvas *c);

/* A linear image of 1 or 3 channels, shown as sRGB, wholly inside the canvas with its top left pixel at (x, y). */
void canvas_paste(canvas *c, const img *image, int x, int y);

/* In ink, UTF-8, the middle of their baseline at (x, y). */
typedef struct canvas_words {
    const char *text;
    int x, y;
} canvas_words;

/* Words in letters of so many pixels, all of them or, if the font is not where the build found it or has not all of
 * their letters, none and false: an SVG finds others. */
bool canvas_write_words(canvas *c, const canvas_words *words, int count, int size);

/* An SVG drawing is begun and printed to; canvas_draw_end lays it over the canvas. */
typedef struct canvas_drawing {
    FILE *out;
    char *text;
    size_t size;
} canvas_drawing;

status canvas_draw_begin(const canvas *c, canvas_drawing *d);
status canvas_draw_end(canvas *c, canvas_drawing *d);
/* Words as an SVG needs them: valid, escaped. */
void canvas_print_escaped(canvas_drawing *d, const char *words);

status canvas_write(const canvas *c, const char *path);

#endif
