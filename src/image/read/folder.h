/* SPDX-License-Identifier: MIT */
/* The files in a folder of pictures, classified by content: photographs, their masks, and everything else.
 *
 *     img_folder f;
 *     status s = img_folder_read("photos", &f);
 *     for (size_t i = 0; i < f.count; i++)
 *         if (img_folder_is_photo(&f.at[i])) use(f.at[i].path);
 *     img_folder_free(&f);
 *
 * A file of unknown format with a picture's name counts as a picture, so that reading it reports what is wrong. */
#ifndef MERLIN_IMAGE_READ_FOLDER_H
#define MERLIN_IMAGE_READ_FOLDER_H

#include <stdbool.h>
#include <stddef.h>

#include "base/skipped.h"
#include "base/status.h"
#include "image/formats/img_format.h"

typedef struct img_folder_file {
    char *path;       /* joined to the folder */
    const char *name; /* last part of the path */
    img_format format;
    bool is_picture;
    bool is_mask; /* by its name (image/read/mask_names.h) and by the files beside it */
    bool is_raw;
} img_folder_file;

typedef struct img_folder {
    img_folder_file *at; /* sorted as by file_list */
    size_t count;
} img_folder;

/* Reads the folder's files, except hidden ones and those that systems leave, such as Thumbs.db. */
status img_folder_read(const char *folder, img_folder *out);
void img_folder_free(img_folder *f);

/* Tells whether a file is a picture and not a mask. */
bool img_folder_is_photo(const img_folder_file *file);
/* Tells whether a file is a camera's JPEG or HEIC of a raw picture beside it. */
bool img_folder_is_beside_raw(const img_folder *f, const img_folder_file *file);
/* Returns the mask of a photograph by name, the best match, or NULL; apart: the folder holds masks, and the photographs
 * may be elsewhere. */
const img_folder_file *img_folder_mask_of(const img_folder *f, const char *photo, bool apart);
/* Returns the mask for the whole folder: mask.png, else a mask for which there is no picture of its name. */
const img_folder_file *img_folder_whole_mask(const img_folder *f);

/* Finds the mask beside a photograph given by its path alone; *mask is malloc'ed, NULL if there is none or the folder
 * cannot be read. */
status img_folder_find_own_mask(const char *photo, char **mask);

/* Adds a skipped file to a list with the reason `why`; a file that is not a picture gets a reason of its own. Files
 * that usually accompany pictures are not listed: side-car files and, in a capture, texts and other data. */
status img_folder_skip(const img_folder_file *file, const char *why, bool capture, skipped_files *list);

#endif
