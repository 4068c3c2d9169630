/* SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/lights/light_list.h"
#include "base/text/text.h"
#include "stereo/arrays/array_file.h"
#include "stereo/capture/capture_parts.h"
#include "stereo/capture/match_lights.h"

enum { TEXT_MOST = 1 << 22 };

/* Terminates a line, and removes quotes and blanks that programs put around a name. */
static char *take_line(char **rest)
{
    char *name = *rest, *end = name + strcspn(name, "\n");
    *rest = end + (*end != 0);
    while (name < end && strchr(" \t\"'", *name))
        name++;
    while (end > name && strchr(" \t\"',;", end[-1]))
        end--;
    *end = 0;
    return name;
}

static status set_name(const char *path, const char *folder, const char *name, int i, merlin_capture *c)
{
    char *found = NULL;
    status s = pst_match_name(folder, name, &found);
    if (s == OK && !found)
        s = fail(MERLIN_BAD_INPUT, "%s names %.80s, but there is no such file in %s", path, name, folder);
    for (int k = 0; k < i && s == OK; k++)
        if (strcmp(c->name[k], found) == 0) s = fail(MERLIN_BAD_INPUT, "%s names %.80s twice", path, found);
    if (s == OK) s = pst_capture_set_name(c, (size_t)i, found);
    free(found);
    return s;
}

/* Reads one file name per line without surrounding blanks; folders are refused, as a list must not lead out of its
 * folder. */
static status take_names(char *text, const char *path, const char *folder, merlin_capture *c)
{
    int count = 0;
    for (char *rest = text; *rest;) {
        const char *name = take_line(&rest);
        if (!*name) continue;
        if (strchr(name, '/')) return fail(MERLIN_BAD_INPUT, "%s: \"%.80s\" is not a plain file name", path, name);
        status s = count < c->count ? set_name(path, folder, name, count, c) : OK;
        if (s != OK) return s;
        count++;
    }
    if (count == c->count) return OK;
    return fail(MERLIN_BAD_INPUT, "%s names %d picture%s, but light_directions.txt has %d light%s", path, count,
                count == 1 ? "" : "s", c->count, c->count == 1 ? "" : "s");
}

static status read_names(const char *path, const char *folder, merlin_capture *c)
{
    char *bytes, *text = NULL;
    size_t size;
    status s = file_read(path, TEXT_MOST, &bytes, &size);
    if (s != OK) return s;
    s = text_decode(bytes, size, path, &text);
    free(bytes);
    if (s == OK) s = take_names(text, path, folder, c);
    free(text);
    return s;
}

/* Reads the pictures named by filenames.txt, unless the list itself has names. */
static status read_named(const char *directions, const char *names, const char *folder,
                         const merlin_capture_files *options, merlin_capture *c)
{
    light_list list;
    status s = light_list_read(directions, &list);
    if (s != OK) return s;
    if (list.name) {
        s = pst_match_lights(folder, options, directions, &list, c);
    } else {
        s = pst_capture_reserve(c, list.count);
        if (s == OK) s = read_names(names, folder, c);
    }
    if (s == OK) s = pst_set_lights(directions, &list, options, c);
    if (s == OK) s = pst_read_strengths(folder, directions, list.intensity, c);
    light_list_free(&list);
    return s;
}

/* Reads the layout. Without filenames.txt pictures are in the order of their names, as readers of the later data sets
 * assume. */
status pst_read_diligent(const char *folder, const merlin_capture_files *options, merlin_capture *c)
{
    const merlin_capture_files apart = {.mask = options->mask, .ambient = options->ambient};
    char *directions = file_join(folder, "light_directions.txt"), *names = file_join(folder, "filenames.txt");
    status s = directions && names ? OK : fail(MERLIN_NO_MEMORY, "no memory for a file name");
    if (s == OK && file_exists(names))
        s = read_named(directions, names, folder, &apart, c);
    else if (s == OK)
        s = pst_read_light_list(folder, directions, &apart, c);
    free(names);
    free(directions);
    return s;
}

static status take_normals(const number_array *a, const char *path, merlin_capture *c)
{
    if (a->size[0] != (size_t)c->height || a->size[1] != (size_t)c->width || a->size[2] != 3)
        return fail(MERLIN_BAD_INPUT, "%s holds %zu x %zu x %zu numbers; expected %d x %d x 3", path, a->size[0],
                    a->size[1], a->size[2], c->height, c->width);
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

status pst_read_diligent_truth(const char *folder, merlin_capture *c)
{
    char *path = file_join(folder, "Normal_gt.mat");
    if (!path) return fail(MERLIN_NO_MEMORY, "no memory for a file name");
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
