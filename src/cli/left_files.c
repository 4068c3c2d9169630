/* SPDX-License-Identifier: MIT */
#include "cli/left_files.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "cli/page.h"
#include "cli/written.h"

enum { TOLD = 160 };

/* Files and folders that one run writes and another does not; a folder of another command is known by one of its files.
 */
static const struct {
    const char *name, *holds;
} optional[] = {{"roughness.png", ""}, {"reconstruction.png", ""}, {"error.png", ""},          {"confidence.png", ""},
                {"mesh.glb", ""},      {"mesh.ply", ""},           {"mesh.obj", ""},           {PAGE_FILE, ""},
                {"relit", ""},         {"rti", "/info.json"},      {"export", "/export.json"}, {"stereo", "/maps.exr"}};

static bool is_left(const char *folder, size_t i, const staged_files *written)
{
    char path[64];
    snprintf(path, sizeof path, "%s%s", optional[i].name, optional[i].holds);
    return file_is_in(folder, path) && !written_has(written, optional[i].name);
}

void left_files_warn(const char *folder, const staged_files *written, warnings *doubts)
{
    char names[TOLD] = "";
    size_t count = 0, length = 0;
    for (size_t i = 0; i < sizeof optional / sizeof *optional && length < sizeof names; i++) {
        if (!is_left(folder, i, written)) continue;
        length += (size_t)snprintf(names + length, sizeof names - length, "%s%s", count ? ", " : "", optional[i].name);
        count++;
    }
    if (count)
        warnings_add(doubts, "files_left",
                     "%s in %s %s not of this run, and may show another object: write %s anew, or remove %s", names,
                     folder, count == 1 ? "is" : "are", count == 1 ? "it" : "them", count == 1 ? "it" : "them");
}

/* ---- frames of a sequence ---- */

#define MAPS "/maps.exr"

/* Returns the part of a path that is a frame's own: "frame_0001/maps.exr". */
static const char *frame_part(const char *path)
{
    const char *at = path + strlen(path) - strlen(MAPS);
    while (at > path && at[-1] != '/')
        at--;
    return at;
}

static int compare_frames(const void *a, const void *b)
{
    return strcmp(frame_part(*(const char *const *)a), frame_part(*(const char *const *)b));
}

/* Returns the frames' maps among the paths, in their order; NULL if there are none, or no memory. */
static const char **sorted_frames(char *const *paths, size_t all, size_t *count)
{
    const char **frames = calloc(all ? all : 1, sizeof *frames);
    *count = 0;
    for (size_t i = 0; i < all && frames; i++) {
        const char *end = strrchr(paths[i], '/');
        if (!end || end == paths[i] || strcmp(end, MAPS) != 0) continue;
        if (strncmp(frame_part(paths[i]), "frame_", 6) == 0) frames[(*count)++] = paths[i];
    }
    if (*count) qsort(frames, *count, sizeof *frames, compare_frames);
    return frames;
}

void left_frames_warn(const char *folder, const staged_files *written, warnings *doubts)
{
    static const char *const endings[] = {".exr", NULL};
    char **paths;
    const char *first = NULL;
    size_t all, found, made, left = 0;
    if (file_list_deep(folder, endings, &paths, &all) != OK) return; /* the frames are written in any case */
    const char **there = sorted_frames(paths, all, &found), **ours = sorted_frames(written->at, written->count, &made);
    for (size_t i = 0; i < found && ours; i++) {
        if (bsearch(&there[i], ours, made, sizeof *ours, compare_frames)) continue;
        if (left++ == 0) first = frame_part(there[i]);
    }
    if (left)
        warnings_add(doubts, "frames_left", "%zu frame%s of an earlier run %s still beside these, %.*s first", left,
                     left == 1 ? "" : "s", left == 1 ? "is" : "are", (int)strcspn(first, "/"), first);
    free(there);
    free(ours);
    file_list_free(paths, all);
}
