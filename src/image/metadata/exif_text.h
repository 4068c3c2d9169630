/* SPDX-License-Identifier: MIT */
/* EXIF as text in a PNG, where programs put it before the format had a chunk for it, and some still do: hexadecimal, in
 * a tEXt or zTXt chunk with the keyword "Raw profile type exif" or "Raw profile type APP1" (ImageMagick's profiles).
 *
 *     void *exif;
 *     size_t size;
 *     if (exif_text_decode(content, length, true, &exif, &size)) exif_parse(exif, size, &facts), free(exif);
 *
 * Strangers' bytes: what is damaged or too long is none. */
#ifndef MERLIN_IMAGE_METADATA_EXIF_TEXT_H
#define MERLIN_IMAGE_METADATA_EXIF_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* Chunks longer than this hold no EXIF. */
enum { EXIF_TEXT_MOST = 1 << 18 };

/* content: a chunk's, keyword first; packed: of zTXt. *exif: malloc'ed, perhaps with "Exif" and two zeros before it. */
bool exif_text_decode(const void *content, size_t size, bool packed, void **exif, size_t *exif_size);

/* The first such chunk of a PNG file; false for every other file. */
bool exif_text_find(FILE *file, void **exif, size_t *exif_size);

#endif
