/* SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "stereo/capture/capture_parts.h"

status pst_find_named(const char *folder, const char *const *usual, char **path)
{
    char **names;
    size_t count;
    *path = NULL;
    status s = file_list(folder, NULL, &names, &count);
    if (s != OK) return s;
    const char *found = NULL;
    for (size_t k = 0; usual[k] && !found; k++)
        for (size_t i = 0; i < count; i++) {
            bool exact = strcmp(file_name_of(names[i]), usual[k]) == 0;
            if (exact || (!found && strcasecmp(file_name_of(names[i]), usual[k]) == 0)) found = names[i];
        }
    if (found && !(*path = strdup(found))) s = fail(MERLIN_NO_MEMORY, "no memory for a file name");
    file_list_free(names, count);
    return s;
}

static status first_with_ending(const char *folder, const char *ending, char **path, size_t *found)
{
    const char *const endings[] = {ending, NULL};
    char **names;
    status s = file_list(folder, endings, &names, found);
    if (s != OK || *found == 0) return s;
    *path = strdup(names[0]);
    file_list_free(names, *found);
    return *path ? OK : fail(MERLIN_NO_MEMORY, "no memory for a file name");
}

status pst_find_file(const char *folder, const char *asked, const char *usual, const char *ending, char **path,
                     size_t *found)
{
    *found = 0;
    *path = asked ? strdup(asked) : file_join(folder, usual);
    if (!*path) return fail(MERLIN_NO_MEMORY, "no memory for a file name");
    if (asked || file_exists(*path)) return OK;
    free(*path);
    *path = NULL;
    return first_with_ending(folder, ending, path, found);
}
