/* SPDX-License-Identifier: MIT */
/* Recognizes a file's format by its content, whatever its name.
 *
 *     img_format f = img_format_of("holiday.jpg");
 *     if (f.is_read) img_read(...);
 *     else if (f.name) say("a %s picture, which is not read", f.name);
 *     else say("not a picture");
 */
#ifndef MERLIN_IMAGE_FORMATS_IMG_FORMAT_H
#define MERLIN_IMAGE_FORMATS_IMG_FORMAT_H

#include <stdbool.h>
#include <stddef.h>

#include "image/metadata/picture_kind.h"

typedef struct img_format {
    picture_kind kind;
    const char *name; /* such as "JPEG 2000", also for formats that are not read; NULL if the file is not a picture */
    bool is_read;
} img_format;

/* Inspects a file; one that cannot be opened or is not a plain file counts as no picture. */
img_format img_format_of(const char *path);
/* Tells whether img_read can read the file's format. */
bool img_is_picture(const char *path);

/* Number of bytes at a file's beginning that suffice to recognize its format. */
enum { IMG_FORMAT_HEAD = 1024 };
/* Returns the format by a file's first bytes, at most IMG_FORMAT_HEAD. Raw pictures in the form of a TIFF are not
 * distinguished from TIFFs, and TGAs, which have no signature, are not recognized. */
img_format img_format_of_head(const void *head, size_t size);

#endif
