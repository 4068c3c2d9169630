/* SPDX-License-Identifier: MIT */
/* merlin/photos: the photographs of a folder, and which of its pictures are their masks.
 *
 *     merlin_photos photos;
 *     if (merlin_photos_list("shoot", NULL, &photos)) fprintf(stderr, "%s\n", merlin_error());
 *     for (size_t i = 0; i < photos.count; i++) use(photos.at[i].path, photos.at[i].mask);
 *     merlin_photos_free(&photos);
 *
 * A mask is known by its name (docs/pictures.md): of cup.jpg it is cup.mask.png, cup_mask.png, mask_cup.png and the
 * like, of any picture's kind; mask.png is that of a folder's only photograph. */
#ifndef MERLIN_PHOTOS_H
#define MERLIN_PHOTOS_H

#include <merlin/files.h>
#include <merlin/status.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct merlin_photo_file {
    char *path; /* joined to the folder */
    char *mask; /* likewise; NULL: none lies beside it */
} merlin_photo_file;

typedef struct merlin_photos {
    merlin_photo_file *at; /* sorted by name */
    size_t count;
    merlin_skipped_files skipped; /* masks that are no photograph's, folders of their own, what is no picture */
} merlin_photos;

/* Lists a folder's photographs, known by their content. What merlin wrote beside maps.exr is none. masks (may be NULL):
 * a folder of masks, which is no skipped folder where it lies in this one. MERLIN_BAD_INPUT if there are none, unless
 * the folder holds maps. */
merlin_status merlin_photos_list(const char *folder, const char *masks, merlin_photos *out);
void merlin_photos_free(merlin_photos *photos);

/* Finds the mask beside a photograph; *mask is yours to give to free, NULL if there is none. */
merlin_status merlin_mask_find(const char *photo, char **mask);
/* Finds the masks of count photographs in a folder of masks, where they may have the photographs' own names, too:
 * masks[i], yours to give to free, is that of photos[i]. MERLIN_BAD_INPUT, with the names that were looked for, if one
 * has none; then all are NULL. */
merlin_status merlin_masks_find(const char *folder, const char *const *photos, size_t count, char **masks);
/* Tells whether a file's name, without folders, may be a mask's by its words: 1 or 0. */
int merlin_mask_is_name(const char *name);

#ifdef __cplusplus
}
#endif

#endif
