/* SPDX-License-Identifier: MIT */
/* Files of boxes in boxes, as HEIC, AVIF and Canon's CR3 are (ISO 14496-12). Sizes and places are believed as far as
 * the file goes: a walk moves on by a box at least, and takes so many steps at most. */
#ifndef MERLIN_IMAGE_METADATA_BOX_FILE_H
#define MERLIN_IMAGE_METADATA_BOX_FILE_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

enum { BOX_MOST_STEPS = 4096 };

typedef struct box {
    uint64_t at, end; /* of what is in it */
} box;

/* The number in so many bytes at a place, the most significant first; 0 where the file has ended. */
uint64_t box_number(FILE *file, uint64_t at, int bytes);
/* Tells whether these four letters stand at a place. */
bool box_name_is(FILE *file, uint64_t at, const char name[4]);
/* Finds the first box of a name among those in `in`. */
bool box_find(FILE *file, box in, const char name[4], box *out);

/* Reads what the picture that is meant in a HEIC or AVIF states of its codes beside a profile: primaries, transfer and
 * matrix by their numbers in ITU-T H.273. False if it states nothing. */
bool box_read_colour(FILE *file, int numbers[3]);

#endif
