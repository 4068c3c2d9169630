/* SPDX-License-Identifier: MIT */
#include "command/photo_folder.h"

#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "command/standard_input.h"
#include "merlin/photos.h"

static status no_memory(void)
{
    return fail(MERLIN_NO_MEMORY, "no memory for file names");
}

status photo_list_add(photo_list *list, const char *photo)
{
    photo_job *larger = realloc(list->at, (list->count + 1) * sizeof *larger);
    if (!larger) return no_memory();
    list->at = larger;
    list->at[list->count] = (photo_job){.photo = strdup(photo)};
    return list->at[list->count++].photo ? OK : no_memory();
}

/* ---- a folder of photographs ---- */

static status add_to_folders(photo_list *list, const char *folder, skipped_files *skipped)
{
    photo_folder *larger = realloc(list->folder, (list->folders + 1) * sizeof *larger);
    if (!larger) return no_memory();
    list->folder = larger;
    photo_folder *added = &larger[list->folders];
    *added = (photo_folder){.path = strdup(folder)};
    if (!added->path) return no_memory();
    list->folders++;
    return skipped_append(&added->skipped, skipped);
}

status photo_folder_add(photo_list *list, const char *folder, const char *masks)
{
    merlin_photos found;
    status s = merlin_photos_list(folder, masks, &found);
    if (s != OK) return s;
    for (size_t i = 0; i < found.count && s == OK; i++) {
        s = photo_list_add(list, found.at[i].path);
        if (s != OK) break;
        list->at[list->count - 1].mask = found.at[i].mask;
        found.at[i].mask = NULL; /* the list's now */
    }
    if (s == OK) s = add_to_folders(list, folder, &found.skipped);
    merlin_photos_free(&found);
    return s;
}

/* ---- masks of photographs that are named ---- */

status photo_own_mask(const char *photo, char **mask)
{
    *mask = NULL;
    return standard_input_is(photo) ? OK : merlin_mask_find(photo, mask);
}

static bool is_mask_of_other(const photo_list *list, size_t i)
{
    for (size_t k = 0; k < list->count; k++)
        if (k != i && list->at[k].mask && file_is_same(list->at[k].mask, list->at[i].photo)) return true;
    return false;
}

void photo_list_drop_masks(photo_list *list)
{
    for (size_t i = 0; i < list->count;) {
        photo_job *job = &list->at[i];
        if (!merlin_mask_is_name(file_name_of(job->photo)) || !is_mask_of_other(list, i)) {
            i++;
            continue;
        }
        free(job->photo);
        free(job->mask);
        memmove(job, job + 1, (--list->count - i) * sizeof *job);
    }
}

status photo_folder_find_masks(photo_list *list, const char *folder)
{
    const char **photos = calloc(list->count + 1, sizeof *photos);
    char **masks = calloc(list->count + 1, sizeof *masks);
    status s = photos && masks ? OK : no_memory();
    for (size_t i = 0; i < list->count && s == OK; i++)
        photos[i] = list->at[i].photo;
    if (s == OK) s = merlin_masks_find(folder, photos, list->count, masks);
    for (size_t i = 0; i < list->count && s == OK; i++) {
        free(list->at[i].mask);
        list->at[i].mask = masks[i];
    }
    free(photos);
    free(masks);
    return s;
}
