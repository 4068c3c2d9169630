/* SPDX-License-Identifier: MIT */
/* Which files of a folder are photographs, and which masks are whose; photos.c makes lists of them. One photograph's
 * own mask is found here, too, by the same names (image/read/mask_names.h). */
#ifndef MERLIN_COMMAND_PHOTO_FOLDER_H
#define MERLIN_COMMAND_PHOTO_FOLDER_H

#include "base/status.h"
#include "command/photo_list.h"

/* Adds one photograph; a copy of its path is kept. */
status photo_list_add(photo_list *list, const char *photo);

/* Adds the folder's photographs with their masks, and what was left aside to list->folder. Of a folder of maps alone
 * nothing is added: estimate * finds those that it has made the last time. masks: a folder of them, or NULL. */
status photo_folder_add(photo_list *list, const char *folder, const char *masks);

/* Gives each photograph its mask from a folder of masks; MERLIN_BAD_INPUT, with the names looked for, if one lacks it.
 */
status photo_folder_find_masks(photo_list *list, const char *folder);

/* Takes out what is the mask of another one by its name: estimate * names masks, too. */
void photo_list_drop_masks(photo_list *list);

/* Finds the mask that lies beside a photograph; *mask is malloc'ed, NULL if there is none. */
status photo_own_mask(const char *photo, char **mask);

#endif
