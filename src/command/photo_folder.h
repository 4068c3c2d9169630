/* SPDX-License-Identifier: MIT */
/* Photographs of folders and their masks, as merlin/photos.h finds them, for the lists of photos.c. */
#ifndef MERLIN_COMMAND_PHOTO_FOLDER_H
#define MERLIN_COMMAND_PHOTO_FOLDER_H

#include "base/status.h"
#include "command/photo_list.h"

/* Adds one photograph, whose path is copied. */
status photo_list_add(photo_list *list, const char *photo);

/* Adds the folder's photographs with their masks, and its skipped files to list->folder. Nothing is added from a folder
 * of maps only, since `estimate *` includes the folders that it wrote before. masks: a folder of them, or NULL. */
status photo_folder_add(photo_list *list, const char *folder, const char *masks);

/* Gives each photograph its mask from a folder of masks; MERLIN_BAD_INPUT, with the names looked for, if one lacks it.
 */
status photo_folder_find_masks(photo_list *list, const char *folder);

/* Removes photographs that are masks of others by their names, as `estimate *` includes masks, too. */
void photo_list_drop_masks(photo_list *list);

/* Finds the mask next to a photograph; *mask is malloc'ed, NULL if there is none. */
status photo_own_mask(const char *photo, char **mask);

#endif
