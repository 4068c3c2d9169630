#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/light_list.h"
#include "stereo/array_file.h"
#include "stereo/capture_parts.h"

enum { TEXT_MOST = 1 << 22 };

/* One file name a line, blanks around it left out, no folders: a list may not lead out of its folder. */
static status take_names(char *text, const char *path, const char *folder, pst_capture *c)
{
    char *rest = NULL;
    int count = 0;
    for (char *name = strtok_r(text, "\r\n", &rest); name; name = strtok_r(NULL, "\r\n", &rest)) {
        name += strspn(name, " \t");
        size_t length = strlen(name);
        while (length > 0 && strchr(" \t", name[length - 1]))
            name[--length] = 0;
        if (!*name) continue;
        if (strchr(name, '/')) return fail(ERROR_INPUT, "%s: \"%.80s\" is not a plain file name", path, name);
        if (count < c->count) {
            if (!file_is_in(folder, name))
                return fail(ERROR_INPUT, "%s names %.80s, but there is no such file in %s", path, name, folder);
            status s = pst_capture_set_name(c, (size_t)count, name);
            if (s != OK) return s;
        }
        count++;
    }
    if (count == c->count) return OK;
    return fail(ERROR_INPUT, "%s names %d pictures, but light_directions.txt has %d lights", path, count, c->count);
}

static status read_names(const char *path, const char *folder, pst_capture *c)
{
    char *text;
    size_t size;
    status s = file_read(path, TEXT_MOST, &text, &size);
    if (s != OK) return s;
    s = take_names(text + file_text_mark(text, size), path, folder, c);
    free(text);
    return s;
}

/* From filenames.txt; where there is none, in the order of their names, as readers of the later sets take them. */
static status take_pictures(const char *folder, const char *lights, size_t count, pst_capture *c)
{
    char *path = file_join(folder, "filenames.txt");
    if (!path) return fail(ERROR_MEMORY, "no memory for a file name");
    status s = OK;
    if (file_exists(path)) {
        s = pst_capture_reserve(c, count);
        if (s == OK) s = read_names(path, folder, c);
    } else {
        s = pst_take_pictures(folder, false, lights, count, c);
    }
    free(path);
    return s;
}

static status read_directions(const char *path, const char *folder, pst_capture *c)
{
    light_list list;
    status s = light_list_read(path, &list);
    if (s != OK) return s;
    if (list.name) s = fail(ERROR_INPUT, "%s: expected x y z a line, not an .lp file", path);
    if (s == OK) s = take_pictures(folder, path, list.count, c);
    for (size_t i = 0; i < list.count && s == OK; i++) {
        c->light[i].direction = vec3_normalize(list.at[i]);
        if (!(vec3_length(c->light[i].direction) > 0.5f))
            s = fail(ERROR_INPUT, "%s: the direction of light %zu has no length", path, i + 1);
    }
    light_list_free(&list);
    return s;
}

status pst_read_diligent(const char *folder, pst_capture *c)
{
    char *directions = file_join(folder, "light_directions.txt");
    if (!directions) return fail(ERROR_MEMORY, "no memory for a file name");
    c->lighting = PST_DISTANT;
    status s = read_directions(directions, folder, c);
    if (s == OK) s = pst_read_intensities(folder, c);
    free(directions);
    return s;
}

static status take_normals(const number_array *a, const char *path, pst_capture *c)
{
    if (a->size[0] != (size_t)c->height || a->size[1] != (size_t)c->width || a->size[2] != 3)
        return fail(ERROR_INPUT, "%s holds %zu x %zu x %zu numbers; expected %d x %d x 3", path, a->size[0], a->size[1],
                    a->size[2], c->height, c->width);
    status s = img_new(&c->normal_true, c->width, c->height, 3);
    for (int y = 0; y < c->height && s == OK; y++)
        for (int x = 0; x < c->width; x++) {
            float *n = img_at(&c->normal_true, x, y);
            for (size_t k = 0; k < 3; k++) {
                float value = a->data[array_at(a, (size_t)y, (size_t)x, k)];
                n[k] = isfinite(value) && *img_at(&c->mask, x, y) > 0 ? value : 0;
            }
        }
    return s;
}

status pst_read_diligent_truth(const char *folder, pst_capture *c)
{
    char *path = file_join(folder, "Normal_gt.mat");
    if (!path) return fail(ERROR_MEMORY, "no memory for a file name");
    status s = OK;
    if (file_exists(path)) {
        number_array a;
        s = mat_read(path, "Normal_gt", &a);
        if (s == OK) s = take_normals(&a, path, c);
        array_free(&a);
    }
    free(path);
    return s;
}
