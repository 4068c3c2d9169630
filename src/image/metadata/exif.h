/* SPDX-License-Identifier: MIT */
/* Reads from EXIF how a photograph was taken: JPEG, PNG, WebP, HEIC, TIFF and cameras' raw files.
 *
 *     exif_facts facts;
 *     status s = exif_read("cup.jpg", &facts);
 *     if (facts.flash == EXIF_FLASH_NONE) ...
 *
 * Files are not trusted: what is missing, damaged or absurd is unknown, and nothing fails. */
#ifndef MERLIN_IMAGE_METADATA_EXIF_H
#define MERLIN_IMAGE_METADATA_EXIF_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "image/metadata/tiff_head.h"

typedef enum exif_flash { EXIF_FLASH_UNKNOWN, EXIF_FLASH_NONE, EXIF_FLASH_FIRED } exif_flash;

/* The colour space. Cameras state Adobe RGB as "uncalibrated", by rule R03 of DCF. */
typedef enum exif_colours { EXIF_COLOURS_UNKNOWN, EXIF_COLOURS_SRGB, EXIF_COLOURS_ADOBE } exif_colours;

typedef struct exif_facts {
    int orientation; /* by the EXIF standard, from 1 (upright) to 8 */
    exif_flash flash;
    exif_colours colours;
    float focal_35mm; /* focal length in mm with the same diagonal field of view on 36 × 24 mm; 0: unknown */
    int wide, high;   /* pixels of the picture that the camera wrote; 0: unknown */
    float exposure;   /* seconds × sensitivity (ISO) / f-number², to which values are proportional; 0: unknown */
} exif_facts;

/* Reads the facts from a picture's EXIF: a TIFF header, perhaps after "Exif" and two zeros. */
void exif_parse(const void *exif, size_t size, exif_facts *out);
/* Reads them from a part of a file or of memory. */
void exif_parse_part(const byte_source *whole, uint64_t at, uint64_t size, exif_facts *out);
/* Reads the facts from a picture's file, of any kind. Fails with MERLIN_NO_MEMORY only. */
status exif_read(const char *path, exif_facts *out);

/* Returns focal_35mm, or 0 if a picture of width × height pixels, either way up, is a crop of what the camera wrote:
 * programs that crop leave the focal length as it was. A crop has another shape than that, or than cameras write. */
float exif_focal_35mm(const exif_facts *facts, int width, int height);

/* Reads the colour space of an EXIF page; page 0: there is none. */
exif_colours exif_colours_of(const tiff_head *t, uint64_t page);

#endif
