/* SPDX-License-Identifier: MIT */
/* What lies in a folder of pictures, told by content: photographs, their masks, and what is neither.
 *
 *     img_folder f;
 *     status s = img_folder_read("photos", &f);
 *     for (size_t i = 0; i < f.count; i++)
 *         if (img_folder_is_photo(&f.at[i])) use(f.at[i].path);
 *     img_folder_free(&f);
 *
 * A file that is of no known kind but is called like a picture counts as one, so that reading it tells what is wrong.
 */
#ifndef MERLIN_IMAGE_READ_FOLDER_H
#define MERLIN_IMAGE_READ_FOLDER_H

#include <stdbool.h>
#include <stddef.h>

#include "base/skipped.h"
#include "base/status.h"
#include "image/formats/img_format.h"

typedef struct img_folder_file {
    char *path;       /* joined to the folder */
    const char *name; /* its last part */
    img_format format;
    bool is_picture;
    bool is_mask; /* by its name (image/read/mask_names.h), and what lies beside it */
    bool is_raw;
} img_folder_file;

typedef struct img_folder {
    img_folder_file *at; /* sorted as file_list does */
    size_t count;
} img_folder;

/* Reads the folder's files, but not hidden ones and what systems leave: Thumbs.db and the like. */
status img_folder_read(const char *folder, img_folder *out);
void img_folder_free(img_folder *f);

/* Tells whether it is a picture and no mask. */
bool img_folder_is_photo(const img_folder_file *file);
/* Tells whether a camera made it of a raw picture beside it, and left both. */
bool img_folder_is_beside_raw(const img_folder *f, const img_folder_file *file);
/* Returns the picture that is the mask of a photograph by its name, the one that fits best, or NULL; apart: the folder
 * is one of masks, where the photographs need not be. */
const img_folder_file *img_folder_mask_of(const img_folder *f, const char *photo, bool apart);
/* Returns the mask that is no single picture's but the folder's: mask.png, else one without a picture of its name. */
const img_folder_file *img_folder_whole_mask(const img_folder *f);

/* Finds the mask that lies beside a photograph, of which nothing but the path is given; *mask is malloc'ed, NULL if
 * there is none or its folder cannot be read. */
status img_folder_find_own_mask(const char *photo, char **mask);

/* Adds to a list a file that was left aside, for a reason; what is no picture gets its own. Files that go with pictures
 * are not worth a word: what programs note beside them, and, in a capture, texts and other data. */
status img_folder_skip(const img_folder_file *file, const char *why, bool capture, skipped_files *list);

#endif
