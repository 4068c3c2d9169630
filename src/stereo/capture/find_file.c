/* SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "stereo/capture/capture_parts.h"

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
