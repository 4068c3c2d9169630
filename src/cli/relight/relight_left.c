/* SPDX-License-Identifier: MIT */
/* Pictures in the same folder that this run did not write: an earlier run's are not removed, but reported; somebody's
 * own are not replaced. */
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/text/map_names.h"
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

/* Refuses to replace a numbered picture beside which the sheet is missing that every run writes with it. */
static status check_numbered(const char *folder, const char *kind, const char *ending, const char *sheet)
{
    char name[24];
    snprintf(name, sizeof name, "%s000%s", kind, ending);
    if (!map_names_is_in(folder, name) || map_names_is_in(folder, sheet)) return OK;
    return map_names_refuse(folder, name, sheet);
}

/* Tells whether a folder is the one within a sequence's that its pictures are usually written to. */
static bool is_within(const merlin_sequence_files *frames, const char *folder)
{
    char *sequence = file_folder_of(frames->at[0].folder), *usual = sequence ? file_join(sequence, "relit") : NULL;
    const bool is = usual && file_is_same(usual, folder);
    free(usual);
    free(sequence);
    return is;
}

/* Refuses to replace frames beside which the video is missing that every run with an encoder writes with them: they are
 * called as a sequence's own photographs often are. */
static status check_frames(const relight_job *job)
{
    if (map_names_is_in(job->output, "relit.mp4") || is_within(job->frames, job->output)) return OK;
    for (size_t i = 0; i < job->frames->count; i++) {
        char name[64], file[80];
        merlin_sequence_folder(job->frames->at[i].number, name, sizeof name);
        snprintf(file, sizeof file, "%s%s", name, relight_ending(job));
        if (map_names_is_in(job->output, file)) return map_names_refuse(job->output, file, "relit.mp4");
    }
    return OK;
}

status relight_check_replaced(const relight_job *job)
{
    status s = OK;
    if (!file_is_folder(job->output)) return OK;
    if (job->frames) return check_frames(job);
    if (relight_count_lights(job) > 1) s = check_numbered(job->output, "relit_", relight_ending(job), "relit.png");
    return s == OK && job->orbit ? check_numbered(job->output, "frame_", ".png", "orbit.png") : s;
}
