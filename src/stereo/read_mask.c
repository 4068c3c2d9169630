#include <stdlib.h>
#include <string.h>

#include "image/folder.h"
#include "image/read.h"
#include "stereo/capture_parts.h"

status pst_find_mask(const char *folder, const char *asked, char **path)
{
    img_folder f = {0};
    *path = NULL;
    if (!asked) {
        status s = img_folder_read(folder, &f);
        if (s != OK) return s;
        const img_folder_file *found = img_folder_whole_mask(&f);
        if (found) asked = found->path;
    }
    if (asked) *path = strdup(asked);
    img_folder_free(&f);
    return !asked || *path ? OK : fail(ERROR_MEMORY, "no memory for a file name");
}

static status check_mask(const char *path, pst_capture *c)
{
    if (c->mask.width != c->width || c->mask.height != c->height)
        return fail(ERROR_INPUT, "the mask %s is %d x %d pixels, but the pictures are %d x %d", path, c->mask.width,
                    c->mask.height, c->width, c->height);
    size_t pixels = (size_t)c->width * (size_t)c->height, inside = 0;
    for (size_t p = 0; p < pixels; p++)
        inside += (c->mask.data[p] = c->mask.data[p] >= 0.5f) > 0;
    return inside ? OK : fail(ERROR_INPUT, "the mask %s is black or transparent everywhere", path);
}

static status find_mask(const char *folder, pst_capture *c)
{
    status s = pst_capture_find_mask(c);
    size_t pixels = (size_t)c->width * (size_t)c->height;
    for (size_t p = 0; p < pixels && s == OK; p++)
        if (c->mask.data[p] > 0) return OK;
    if (s != OK) return s;
    return fail(ERROR_INPUT, "the pictures of %s are black: nothing is above %g %% of full scale; give a mask", folder,
                (double)(100 * PST_BLACK));
}

status pst_read_mask(const char *folder, const pst_read_options *options, pst_capture *c)
{
    char *path;
    status s = pst_find_mask(folder, options->mask, &path);
    if (s != OK) return s;
    if (path) {
        s = img_read_mask(path, &c->mask);
        if (s == OK) s = check_mask(path, c);
    } else {
        s = find_mask(folder, c);
    }
    if (s == OK) s = pst_list_skipped(folder, path, options->ambient, c);
    free(path);
    return s;
}
