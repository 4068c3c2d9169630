/* SPDX-License-Identifier: MIT */
/* Reads the directories of a TIFF (TIFF 6.0 and BigTIFF), or of EXIF, which has the form of a TIFF: its pages, in a
 * chain and each perhaps with sub-pages, and the numbers in them.
 *
 *     tiff_head t;
 *     if (tiff_open(&t, &source)) width = tiff_value(&t, t.page[0], TIFF_WIDTH);
 */
#ifndef MERLIN_IMAGE_METADATA_TIFF_HEAD_H
#define MERLIN_IMAGE_METADATA_TIFF_HEAD_H

#include <stdbool.h>
#include <stdint.h>

#include "image/metadata/byte_source.h"

enum { TIFF_MOST_PAGES = 64 };

enum {
    TIFF_KIND = 254, /* bits: 1 reduced, 4 a mask */
    TIFF_WIDTH = 256,
    TIFF_HEIGHT = 257,
    TIFF_BITS = 258,
    TIFF_COMPRESSION = 259,
    TIFF_PHOTOMETRIC = 262,
    TIFF_STRIPS = 273,
    TIFF_ORIENTATION = 274,
    TIFF_SAMPLES = 277,
    TIFF_STRIP_HEIGHT = 278,
    TIFF_STRIP_SIZES = 279,
    TIFF_PLANES = 284,
    TIFF_TRANSFER = 301,
    TIFF_PREDICTOR = 317,
    TIFF_WHITE = 318,
    TIFF_PRIMARIES = 319,
    TIFF_TILE_WIDTH = 322,
    TIFF_TILE_HEIGHT = 323,
    TIFF_TILES = 324,
    TIFF_TILE_SIZES = 325,
    TIFF_BELOW = 330,
    TIFF_EXTRA_SAMPLES = 338,
    TIFF_SAMPLE_FORMAT = 339,
    TIFF_EXIF = 34665,
    TIFF_EXIF_COLOUR_SPACE = 40961,
    TIFF_EXIF_INTEROPERABILITY = 40965,
    TIFF_DNG_VERSION = 50706,
};

typedef struct tiff_head {
    byte_source *from;
    bool big_endian, wide;
    uint64_t page[TIFF_MOST_PAGES]; /* positions of the pages */
    int pages;                      /* number of pages in the chain; at most TIFF_MOST_PAGES positions are stored */
} tiff_head;

/* Finds the pages of an open file; returns false if it is not a TIFF or has none. */
bool tiff_open(tiff_head *t, byte_source *from);
/* Returns the first number of an entry of a page, of 8, 16 or 32 bits, or its first letter; 0 if there is none. */
uint32_t tiff_value(const tiff_head *t, uint64_t page, unsigned tag);
/* Return how many numbers an entry has, and one of them by index. */
uint64_t tiff_count(const tiff_head *t, uint64_t page, unsigned tag);
uint32_t tiff_value_at(const tiff_head *t, uint64_t page, unsigned tag, uint64_t index);
/* Return the first number of an entry, or one by index, whether integer, fraction or float; 0 if there is none. */
double tiff_real(const tiff_head *t, uint64_t page, unsigned tag);
double tiff_real_at(const tiff_head *t, uint64_t page, unsigned tag, uint64_t index);

#endif
