/* SPDX-License-Identifier: MIT */
/* Reads from its EXIF how a photograph was taken: of JPEG, PNG, WebP, HEIC, TIFF and cameras' raw files.
 *
 *     exif_facts facts;
 *     exif_read("cup.jpg", &facts);
 *     if (facts.flash == EXIF_FLASH_NONE) ...
 *
 * Strangers' bytes: what is missing, damaged or absurd is unknown, and nothing fails. */
#ifndef MERLIN_IMAGE_METADATA_EXIF_H
#define MERLIN_IMAGE_METADATA_EXIF_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "image/metadata/tiff_head.h"

typedef enum exif_flash { EXIF_FLASH_UNKNOWN, EXIF_FLASH_NONE, EXIF_FLASH_FIRED } exif_flash;

/* Adobe RGB as cameras tell it: uncalibrated, by rule R03 of DCF. */
typedef enum exif_colours { EXIF_COLOURS_UNKNOWN, EXIF_COLOURS_SRGB, EXIF_COLOURS_ADOBE } exif_colours;

typedef struct exif_facts {
    int orientation; /* by the EXIF standard, from 1 (upright) to 8 */
    exif_flash flash;
    exif_colours colours;
    float focal_35mm; /* the focal length in mm whose picture on 36 × 24 mm has as wide a diagonal; 0: unknown */
} exif_facts;

/* Takes the facts from a picture's EXIF: a TIFF's head, perhaps behind "Exif" and two zeros. */
void exif_parse(const void *exif, size_t size, exif_facts *out);
/* Takes them from a picture's file, of whatever kind. */
void exif_read(const char *path, exif_facts *out);

/* Reads the colour space in an EXIF page, whose place may be 0 for none. */
exif_colours exif_colours_of(const tiff_head *t, uint64_t page);

#endif
