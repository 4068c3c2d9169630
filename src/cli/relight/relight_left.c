/* SPDX-License-Identifier: MIT */
/* Pictures of an earlier run in the same folder: they are not removed, since this run did not write them, but reported.
 */
#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "base/file.h"
#include "cli/relight/relight_parts.h"
#include "cli/written.h"

bool relight_is_numbered(const char *name, const char *kind)
{
    size_t length = strlen(kind);
    if (strncmp(name, kind, length) != 0) return false;
    for (size_t i = length; i < length + 3; i++)
        if (!isdigit((unsigned char)name[i])) return false;
    return strcmp(name + length + 3, ".png") == 0 || strcmp(name + length + 3, ".jpg") == 0;
}

void relight_find_left(const relight_job *job, relight_result *result)
{
    static const char *const endings[] = {".png", ".jpg", NULL};
    char **paths;
    size_t count;
    if (file_list(job->output, endings, &paths, &count) != OK) return; /* the pictures are written in any case */
    for (size_t i = 0; i < count; i++) {
        const char *name = file_name_of(paths[i]);
        const bool beside = (relight_count_whole(job) > 0 && relight_is_numbered(name, "relit_")) ||
                            (job->orbit > 0 && relight_is_numbered(name, "frame_")) ||
                            (job->frames && strncmp(name, "frame_", 6) == 0);
        if (!beside || written_has(&result->files, paths[i])) continue;
        if (result->left++ == 0) snprintf(result->left_name, sizeof result->left_name, "%s", name);
    }
    file_list_free(paths, count);
}
