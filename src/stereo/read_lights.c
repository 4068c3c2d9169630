#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "base/light_list.h"
#include "stereo/capture_parts.h"
#include "stereo/text_numbers.h"

enum { TEXT_MOST = 1 << 22 };

/* lights.txt, else the folder's .lp; *path is NULL if there is neither. */
static status find_lights(const char *folder, const char *asked, char **path)
{
    size_t found;
    status s = pst_find_file(folder, asked, "lights.txt", ".lp", path, &found);
    if (s != OK || found < 2) return s;
    free(*path);
    *path = NULL;
    return fail(ERROR_INPUT, "%s has %zu .lp files; name the one that holds the lights", folder, found);
}

/* The name alone of what an .lp line may give with a path from another machine. */
static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/'), *backslash = strrchr(path, '\\');
    const char *last = slash > backslash ? slash : backslash;
    return last ? last + 1 : path;
}

/* A folder and all its files. */
typedef struct listing {
    const char *folder;
    char **paths;
    size_t count;
} listing;

/* The folder's file of that name, in capitals or not, such as a list from Windows may have; NULL if there is not
 * exactly one. */
static const char *find_listed(const listing *in, const char *listed)
{
    const char *name = base_name(listed), *found = NULL;
    size_t alike = 0;
    for (size_t i = 0; i < in->count; i++) {
        const char *last = base_name(in->paths[i]);
        if (strcmp(last, name) == 0) return last;
        if (strcasecmp(last, name) != 0) continue;
        found = last;
        alike++;
    }
    return alike == 1 ? found : NULL;
}

static bool none_is_there(const listing *in, const light_list *list)
{
    for (size_t i = 0; i < list->count; i++)
        if (find_listed(in, list->name[i])) return false;
    return true;
}

/* And not with numbers behind it, of columns that are not known here. */
static bool ends_as_a_file(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot && isalpha((unsigned char)dot[1]) && !strpbrk(dot, " \t,");
}

static bool are_files_in_order(const light_list *list)
{
    for (size_t i = 0; i < list->count; i++)
        if (!ends_as_a_file(list->name[i]) ||
            (i && strverscmp(base_name(list->name[i - 1]), base_name(list->name[i])) >= 0))
            return false;
    return true;
}

static status names_from_listing(const listing *in, const char *lights, const light_list *list, pst_capture *c)
{
    status s = pst_capture_reserve(c, list->count);
    for (size_t i = 0; i < list->count && s == OK; i++) {
        const char *found = find_listed(in, list->name[i]);
        s = found ? pst_capture_set_name(c, i, found)
                  : fail(ERROR_INPUT, "%s names %s, but there is no %s/%s", lights, list->name[i], in->folder,
                         base_name(list->name[i]));
    }
    return s;
}

/* A dome's list is made once, with the names of the pictures of then, and is used for every object: where none of its
 * names is there, its lights are the folder's pictures' in their order. */
static status names_from_list(const char *folder, const char *lights, const light_list *list, pst_capture *c)
{
    listing in = {.folder = folder};
    status s = file_list(folder, NULL, &in.paths, &in.count);
    if (s != OK) return s;
    c->lights_in_order = none_is_there(&in, list) && are_files_in_order(list);
    if (c->lights_in_order) {
        s = pst_take_pictures(folder, false, lights, list->count, c);
        if (s != OK) s = fail_in(s, "%s names pictures of another folder", lights);
    } else {
        s = names_from_listing(&in, lights, list, c);
    }
    file_list_free(in.paths, in.count);
    return s;
}

/* Distant lights' directions, which were meant for no --near: as positions, all are as far from the camera, and some
 * behind it. */
static bool are_directions(const light_list *list)
{
    bool behind = false;
    for (size_t i = 0; i < list->count; i++) {
        if (fabsf(vec3_length(list->at[i]) - 1) > 1e-3f) return false;
        behind |= list->at[i].z > 0.1f;
    }
    return behind;
}

/* An .lp file's numbers are directions, which a dome has from its middle, unless they are too long or too short. */
static bool are_written_positions(const light_list *list)
{
    for (size_t i = 0; list->name && i < list->count; i++)
        if (fabsf(list->length[i] - 1) > 0.02f) return true;
    return false;
}

/* Adds the origin of an .lp file's positions, in the camera's space: the object, which a dome stands round. Lights
 * behind it would light nothing that is seen, so that where all z are negative the camera must be meant. */
static status find_origin(const char *path, const light_list *list, float distance, vec3 *origin)
{
    size_t before = 0;
    *origin = vec3_make(0, 0, 0);
    for (size_t i = 0; i < list->count; i++)
        before += light_list_written(list, i).z > (real)1e-4 * list->length[i];
    if (before == 0) return OK;
    bool units = !are_written_positions(list);
    if (distance > 0 || units) *origin = vec3_make(0, 0, distance > 0 ? -distance : -1);
    if (before < list->count && !units)
        return fail(ERROR_INPUT,
                    "%s has lights before and behind z = 0, so that its positions may be about the object or from the "
                    "camera; list them from the camera, as x y z a line in a .txt file",
                    path);
    if (vec3_length(*origin) > 0) return OK;
    return fail(ERROR_INPUT,
                "%s lists positions about the object, as an .lp file does: say how far the camera is by --distance, or "
                "list them from the camera in a .txt file, or take them for distant lights without --near",
                path);
}

static status set_positions(const char *path, const light_list *list, float distance, pst_capture *c)
{
    vec3 origin = {0, 0, 0};
    if (are_directions(list))
        return fail(ERROR_INPUT, "%s lists directions (all of length 1), not the positions of near lights", path);
    status s = list->name ? find_origin(path, list, distance, &origin) : OK;
    for (size_t i = 0; i < list->count && s == OK; i++)
        c->light[i].position = list->name ? vec3_add(light_list_written(list, i), origin) : list->at[i];
    return s;
}

static status set_directions(const char *path, const light_list *list, pst_capture *c)
{
    for (size_t i = 0; i < list->count; i++) {
        c->light[i].direction = list->name ? light_list_direction(list, i) : vec3_normalize(list->at[i]);
        if (!(vec3_length(c->light[i].direction) > 0.5f))
            return fail(ERROR_INPUT, "%s: the direction of light %zu has no length", path, i + 1);
    }
    return OK;
}

static status set_lights(const char *path, const light_list *list, const pst_read_options *options, pst_capture *c)
{
    c->lighting = options->near ? PST_NEAR : PST_DISTANT;
    c->intensities_known = true; /* who lists lights and says nothing of their intensities means equal ones */
    return options->near ? set_positions(path, list, options->distance, c) : set_directions(path, list, c);
}

static status set_one_intensity(const text_numbers *t, float intensity[3])
{
    if (t->count != 1 && t->count != 3)
        return fail(ERROR_INPUT, "%s:%d: expected one or three intensities", t->where, t->line);
    for (int k = 0; k < 3; k++) {
        double value = t->value[t->count == 3 ? k : 0];
        if (!(value > 0 && value < 1e12))
            return fail(ERROR_INPUT, "%s:%d: an intensity must be above zero, not %g", t->where, t->line, value);
        intensity[k] = (float)value;
    }
    return OK;
}

static status read_intensities(const char *path, pst_capture *c)
{
    char *text;
    size_t size;
    status s = file_read(path, TEXT_MOST, &text, &size);
    if (s != OK) return s;
    text_numbers t = text_numbers_at(text, size, path);
    int count = 0;
    bool found = true;
    while (s == OK && (s = text_numbers_next(&t, &found)) == OK && found) {
        if (t.count == 0 && count == 0) continue; /* words before the numbers */
        if (count < c->count) s = set_one_intensity(&t, c->light[count].intensity);
        count++;
    }
    free(text);
    if (s == OK && count != c->count)
        s = fail(ERROR_INPUT, "%s has %d intensities for %d lights", path, count, c->count);
    c->intensities_known = s == OK;
    return s;
}

status pst_read_intensities(const char *folder, pst_capture *c)
{
    char *path = file_join(folder, "light_intensities.txt");
    if (!path) return fail(ERROR_MEMORY, "no memory for a file name");
    status s = file_exists(path) ? read_intensities(path, c) : OK;
    free(path);
    return s;
}

static status read_listed(const char *folder, const char *lights, const pst_read_options *options, pst_capture *c)
{
    light_list list;
    status s = light_list_read(lights, &list);
    if (s != OK) return s;
    s = list.name ? names_from_list(folder, lights, &list, c) : pst_take_pictures(folder, false, lights, list.count, c);
    if (s == OK) s = set_lights(lights, &list, options, c);
    light_list_free(&list);
    return s;
}

status pst_read_plain(const char *folder, const pst_read_options *options, pst_capture *c)
{
    char *lights = NULL;
    if (options->unknown_lights) {
        status s = pst_take_pictures(folder, false, NULL, 0, c);
        return s == OK ? pst_read_intensities(folder, c) : s;
    }
    status s = find_lights(folder, options->lights, &lights);
    if (s == OK && !lights) s = pst_check_pictures(folder);
    if (s == OK && !lights)
        return fail(ERROR_INPUT,
                    "%s says nothing of its lights (no lights.txt, .lp, LUCES or DiLiGenT files); name the file that "
                    "holds them, or use method uncalibrated",
                    folder);
    if (s == OK) s = read_listed(folder, lights, options, c);
    if (s == OK) s = pst_read_intensities(folder, c);
    free(lights);
    return s;
}
