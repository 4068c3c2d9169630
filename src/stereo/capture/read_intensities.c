/* SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>

#include "base/lights/light_strengths.h"
#include "stereo/capture/capture_parts.h"
#include "stereo/capture/match_lights.h"

typedef struct pictures_of {
    const char *folder;
    const merlin_capture *capture;
} pictures_of;

static status find_picture(void *context, const char *name, size_t *light)
{
    const pictures_of *in = context;
    char *found = NULL;
    status s = pst_match_name(in->folder, name, &found);
    *light = (size_t)in->capture->count;
    for (int i = 0; i < in->capture->count && found; i++)
        if (strcmp(in->capture->name[i], found) == 0) *light = (size_t)i;
    free(found);
    return s;
}

static status read_all(const char *path, const char *folder, merlin_capture *c)
{
    const size_t count = (size_t)c->count;
    float(*value)[3] = calloc(count, sizeof *value);
    if (!value) return fail(MERLIN_NO_MEMORY, "no memory for %zu intensities", count);
    pictures_of in = {folder, c};
    status s = light_strengths_read(path, &(light_strengths){count, value, find_picture, &in, folder});
    for (size_t i = 0; i < count && s == OK; i++)
        memcpy(c->light[i].intensity, value[i], sizeof value[i]);
    c->intensities_known = c->intensities_listed = s == OK;
    free(value);
    return s;
}

status pst_read_strengths(const char *folder, const char *lights, bool listed, merlin_capture *c)
{
    char *path;
    status s = light_strengths_find(folder, lights, listed, &path);
    if (s == OK && path) s = read_all(path, folder, c);
    free(path);
    return s;
}
