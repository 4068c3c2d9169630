/* SPDX-License-Identifier: MIT */
/* EXIF as text in a PNG, as programs stored it before the format had a chunk for it, and some still do: hexadecimal, in
 * a tEXt or zTXt chunk with the keyword "Raw profile type exif" or "Raw profile type APP1" (ImageMagick's profiles).
 *
 *     void *exif;
 *     size_t size;
 *     status s = exif_text_decode(content, length, true, &exif, &size);
 *     if (s == OK && exif) exif_parse(exif, size, &facts);
 *     free(exif);
 *
 * Files are not trusted: text that is damaged or too long counts as none. The functions fail with MERLIN_NO_MEMORY
 * only.
 */
#ifndef MERLIN_IMAGE_METADATA_EXIF_TEXT_H
#define MERLIN_IMAGE_METADATA_EXIF_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "image/metadata/byte_source.h"

/* Largest chunk that is searched for EXIF, bytes. */
enum { EXIF_TEXT_MOST = 1 << 18 };

/* Decodes a chunk. content: the chunk's, keyword first; packed: it is a zTXt. *exif: malloc'ed, perhaps beginning with
 * "Exif" and two zeros; NULL if there is none. */
status exif_text_decode(const void *content, size_t size, bool packed, void **exif, size_t *exif_size);

/* Decodes the chunk whose content is at a position. */
status exif_text_decode_at(byte_source *from, uint64_t at, size_t size, bool packed, void **exif, size_t *exif_size);

/* Finds the first such chunk of a PNG file; *exif is NULL for other files. */
status exif_text_find(byte_source *from, void **exif, size_t *exif_size);

#endif
