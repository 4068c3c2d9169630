/* SPDX-License-Identifier: MIT */
#include <stdlib.h>

#include "image/read/folder.h"
#include "image/read/read.h"
#include "image/resize.h"
#include "lab/render/environment.h"

/* Reads one map and resizes it. Negative values are set to black first, so that they do not spread to their neighbours;
 * enlarging creates new ones, which are set to black, too. */
static status read_map(const char *path, img *out)
{
    img full = {0};
    status s = img_read_latlong(path, &full);
    if (s != OK) return s;
    img_zero_invalid(&full);
    s = img_resize(&full, ENVIRONMENT_WIDTH, ENVIRONMENT_HEIGHT, out);
    img_free(&full);
    if (s != OK) return fail_in(s, "cannot use %s as an environment", path);
    img_zero_invalid(out);
    return OK;
}

static status refuse_empty(const char *path, const skipped_files *skipped)
{
    char left[256];
    skipped_words(skipped, left, sizeof left);
    return fail(MERLIN_BAD_INPUT, "%s: no environment maps (HDR, EXR, ...) in this folder%s%s", path, *left ? "; " : "",
                left);
}

status environment_folder_read(const char *path, environment_folder *out)
{
    img_folder f;
    *out = (environment_folder){0};
    status s = img_folder_read(path, &f);
    if (s != OK) return s;
    if (!(out->maps = calloc(f.count + 1, sizeof *out->maps))) s = fail(MERLIN_NO_MEMORY, "out of memory for maps");
    for (size_t i = 0; s == OK && i < f.count; i++)
        s = f.at[i].is_picture ? read_map(f.at[i].path, &out->maps[out->count++])
                               : img_folder_skip(&f.at[i], "no picture", false, &out->skipped);
    if (s == OK && out->count == 0) s = refuse_empty(path, &out->skipped);
    img_folder_free(&f);
    if (s != OK) environment_folder_free(out);
    return s;
}

void environment_folder_free(environment_folder *folder)
{
    for (size_t i = 0; i < folder->count; i++)
        img_free(&folder->maps[i]);
    free(folder->maps);
    skipped_free(&folder->skipped);
    *folder = (environment_folder){0};
}
