/* SPDX-License-Identifier: MIT */
/* Files of nested boxes (ISO 14496-12): HEIC, AVIF and Canon's CR3. Sizes and positions are trusted within the file's
 * length: each step advances by at least a box header, and the number of steps is limited. */
#ifndef MERLIN_IMAGE_METADATA_BOX_FILE_H
#define MERLIN_IMAGE_METADATA_BOX_FILE_H

#include <stdbool.h>
#include <stdint.h>

#include "image/metadata/byte_source.h"

enum { BOX_MOST_STEPS = 4096 };

typedef struct media_box {
    uint64_t at, end; /* range of the content */
} media_box;

/* Reads a big-endian number of so many bytes at a position; 0 at the file's end. */
uint64_t box_number(byte_source *from, uint64_t at, int bytes);
/* Tells whether these four letters are at a position. */
bool box_name_is(byte_source *from, uint64_t at, const char name[4]);
/* Finds the first box of a name inside `in`. */
bool box_find(byte_source *from, media_box in, const char name[4], media_box *out);

/* Reads what a HEIC or AVIF states about its primary picture's codes beside a profile: primaries, transfer and matrix
 * as code points of ITU-T H.273. Returns false if it states nothing. */
bool box_read_colour(byte_source *from, int numbers[3]);

#endif
