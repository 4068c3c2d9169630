/* SPDX-License-Identifier: MIT */
/* Finds the EXIF of a picture's file, of whatever kind. */
#ifndef MERLIN_IMAGE_METADATA_EXIF_FIND_H
#define MERLIN_IMAGE_METADATA_EXIF_FIND_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* Place in a file of its EXIF. */
typedef struct exif_place {
    uint64_t at;
    size_t size; /* 0: all of the file is a TIFF */
} exif_place;
bool exif_find(FILE *file, exif_place *out);

#endif
