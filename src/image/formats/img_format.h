/* SPDX-License-Identifier: MIT */
/* What a file is by its content: its name may say anything.
 *
 *     img_format f = img_format_of("holiday.jpg");
 *     if (f.is_read) img_read(...);
 *     else if (f.name) say("a %s picture, which is not read", f.name);
 *     else say("no picture at all");
 */
#ifndef MERLIN_IMAGE_FORMATS_IMG_FORMAT_H
#define MERLIN_IMAGE_FORMATS_IMG_FORMAT_H

#include <stdbool.h>
#include <stddef.h>

#include "image/metadata/picture_kind.h"

typedef struct img_format {
    picture_kind kind;
    const char *name; /* "JPEG 2000", also of formats that are not read; NULL of what is no picture */
    bool is_read;
} img_format;

/* Looks into a file; what cannot be opened or is no plain file is no picture. */
img_format img_format_of(const char *path);
/* Tells whether img_read reads files of this one's format. */
bool img_is_picture(const char *path);

/* Bytes of a file's beginning that are enough to know its format. */
enum { IMG_FORMAT_HEAD = 1024 };
/* Returns the format by a file's first bytes, at most IMG_FORMAT_HEAD; TIFFs are not told from raw pictures of a TIFF's
 * form, and TGAs, which begin like much else, are not known. */
img_format img_format_of_head(const void *head, size_t size);

#endif
