/* SPDX-License-Identifier: MIT */
/* Finds the EXIF of a picture's file, of any kind. */
#ifndef MERLIN_IMAGE_METADATA_EXIF_FIND_H
#define MERLIN_IMAGE_METADATA_EXIF_FIND_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "image/metadata/byte_source.h"

/* Position of EXIF in a file. */
typedef struct exif_place {
    uint64_t at;
    size_t size; /* 0: the whole file is a TIFF */
} exif_place;
bool exif_find(byte_source *from, exif_place *out);

#endif
