#include <stdlib.h>

#include "base/file.h"
#include "image/read.h"
#include "image/resize.h"
#include "render/environment.h"

/* Reads one map and resizes it. Negative values of odd files count as black, before they take light from those beside
 * them or give it; enlarging, too, makes some. */
static status read_map(const char *path, img *out)
{
    img full = {0};
    status s = img_read_latlong(path, &full);
    if (s != OK) return s;
    img_blacken_impossible(&full);
    s = img_resize(&full, ENVIRONMENT_WIDTH, ENVIRONMENT_HEIGHT, out);
    img_free(&full);
    if (s != OK) return fail_in(s, "cannot use %s as an environment", path);
    img_blacken_impossible(out);
    return OK;
}

status environment_folder_read(const char *path, environment_folder *out)
{
    static const char *const endings[] = {".hdr", ".exr", ".tif", ".tiff", ".png", ".jpg", ".jpeg", NULL};
    char **names;
    size_t count;
    *out = (environment_folder){0};
    status s = file_list(path, endings, &names, &count);
    if (s != OK) return s;
    if (count == 0) s = fail(ERROR_INPUT, "%s: no environment maps (.hdr, .exr, ...) in this folder", path);
    if (s == OK && !(out->maps = calloc(count, sizeof *out->maps))) s = fail(ERROR_MEMORY, "out of memory for maps");
    for (size_t i = 0; s == OK && i < count; i++) {
        s = read_map(names[i], &out->maps[i]);
        out->count = i + 1;
    }
    file_list_free(names, count);
    if (s != OK) environment_folder_free(out);
    return s;
}

void environment_folder_free(environment_folder *folder)
{
    for (size_t i = 0; i < folder->count; i++)
        img_free(&folder->maps[i]);
    free(folder->maps);
    *folder = (environment_folder){0};
}
