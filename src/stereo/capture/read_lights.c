/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "base/lights/light_list.h"
#include "stereo/capture/capture_parts.h"
#include "stereo/capture/match_lights.h"

/* Finds the file requested, else lights.txt and similar names, else the folder's .lp; *path is NULL if there is none.
 */
static status find_lights(const char *folder, const char *asked, char **path)
{
    size_t found = 0;
    *path = NULL;
    status s = asked ? OK : file_find_named(folder, light_list_names, path);
    if (s == OK && !*path) s = pst_find_file(folder, asked, "lights.txt", ".lp", path, &found);
    if (s != OK || found < 2) return s;
    free(*path);
    *path = NULL;
    return fail(MERLIN_BAD_INPUT, "%s has %zu .lp files; name the one that holds the lights", folder, found);
}

/* Returns the index of the light for the same picture as a list's i-th: of its name, where both lists have names. */
static size_t counterpart(const light_list *list, size_t i, const light_list *other)
{
    for (size_t k = 0; k < other->count && list->name && other->name && list->name[i]; k++)
        if (other->name[k] && strcasecmp(file_name_of(list->name[i]), file_name_of(other->name[k])) == 0) return k;
    return i;
}

/* Tells whether two lists have the same directions, up to what rounding to few decimals makes. */
static bool are_alike(const light_list *a, const light_list *b)
{
    static const double most = 1; /* degrees */
    if (a->count != b->count) return false;
    for (size_t i = 0; i < a->count; i++)
        if (!(vec3_angle(a->at[i], b->at[counterpart(a, i, b)]) <= most)) return false;
    return true;
}

/* Warns of a file that lists other lights than the one that is used. */
static status compare_lists(const char *path, const char *other, merlin_capture *c)
{
    light_list used = {0}, left = {0};
    status s = light_list_read(path, &used);
    if (s == OK) s = light_list_read(other, &left);
    if (s == OK && !are_alike(&used, &left))
        warnings_add(
            &c->noticed, "lists_differ",
            "the lights are those of %s, but %s lists other ones: remove it, or say by --lights which is meant", path,
            file_name_of(other));
    light_list_free(&used);
    light_list_free(&left);
    return s == MERLIN_NO_MEMORY ? s : OK; /* what cannot be read lists no lights */
}

/* Compares the list that was found in a folder with others that are there. */
static status check_other_lists(const char *folder, const char *path, merlin_capture *c)
{
    char **names;
    size_t count;
    status s = file_list(folder, NULL, &names, &count);
    if (s != OK) return s;
    for (size_t i = 0; i < count && s == OK; i++) {
        const char *name = file_name_of(names[i]);
        if (light_list_is_name(name) && strcmp(name, file_name_of(path)) != 0) s = compare_lists(path, names[i], c);
    }
    file_list_free(names, count);
    return s;
}

/* Tells whether lights listed for --near are directions: as positions they would all be at one distance from the
 * camera, and some behind it. */
static bool are_directions(const light_list *list)
{
    bool behind = list->angles;
    for (size_t i = 0; i < list->count; i++)
        behind = behind || list->at[i].z > 0.1f;
    return behind && light_list_is_unit(list);
}

/* Tells whether the numbers are too long or too short for directions from the middle of a dome. */
static bool are_places(const light_list *list)
{
    for (size_t i = 0; i < list->count; i++)
        if (fabsf(vec3_length(list->at[i]) - 1) > 0.02f) return true;
    return false;
}

/* Tells whether some light is in front of (side 1) or behind (side -1) the plane z = 0. */
static bool has_some(const light_list *list, real side)
{
    for (size_t i = 0; i < list->count; i++)
        if (side * list->at[i].z > (real)1e-4 * vec3_length(list->at[i])) return true;
    return false;
}

/* Determines whether an .lp file's positions are relative to the object, around which a dome stands. Lights behind it
 * would light nothing visible, so that positions with only negative z must be relative to the camera. */
static status find_frame(const char *path, const light_list *list, bool *about)
{
    *about = has_some(list, 1);
    if (!*about || !has_some(list, -1) || !are_places(list)) return OK;
    return fail(MERLIN_BAD_INPUT,
                "%s has lights before and behind z = 0, so that its positions may be about the object or from the "
                "camera; list them from the camera, as x y z a line in a .txt file",
                path);
}

static status set_positions(const char *path, const light_list *list, merlin_capture *c)
{
    if (list->angles || (!list->about_object && are_directions(list)))
        return fail(MERLIN_BAD_INPUT, "%s lists directions (all of length 1), not the positions of near lights", path);
    for (size_t i = 0; i < list->count; i++)
        vec3_put(list->at[i], c->light[i].position);
    return list->about_object ? find_frame(path, list, &c->about_object) : OK;
}

static void note_places(const char *path, const light_list *list, merlin_capture *c)
{
    real least = HUGE_VALF, most = 0;
    for (size_t i = 0; i < list->count; i++) {
        least = fminf(least, vec3_length(list->at[i]));
        most = fmaxf(most, vec3_length(list->at[i]));
    }
    char range[64];
    snprintf(range, sizeof range, most > 1.02f * least ? "%.3g to %.3g" : "%.3g", (double)least, (double)most);
    warnings_add(&c->noticed, "lights_have_places",
                 "the lights in %s are %s long, as places are, and were taken for directions: --near heeds places",
                 path, range);
}

static status set_directions(const char *path, const light_list *list, merlin_capture *c)
{
    for (size_t i = 0; i < list->count; i++) {
        vec3_put(light_list_direction(list, i), c->light[i].direction);
        if (!(vec3_length(vec3_of(c->light[i].direction)) > 0.5f))
            return fail(MERLIN_BAD_INPUT, "%s:%d: the direction has no length", path, list->line[i]);
    }
    if (!are_places(list)) return OK;
    if (!list->about_object && !has_some(list, 1))
        return fail(MERLIN_BAD_INPUT,
                    "the lights in %s are behind or beside the object if they are directions (z is nowhere above 0), "
                    "but not of length 1: if they are places, measured from the camera, give --near",
                    path);
    c->about_object = list->about_object && has_some(list, 1) && !has_some(list, -1);
    for (size_t i = 0; i < list->count && c->about_object; i++)
        vec3_put(list->at[i], c->light[i].position);
    if (!c->about_object) note_places(path, list, c);
    return OK;
}

/* Copies the intensities; pictures are divided by them, so that a light of a pure colour is refused. */
static status set_intensities(const char *path, const light_list *list, merlin_capture *c)
{
    for (size_t i = 0; i < list->count && list->intensity; i++) {
        const vec3 e = list->intensity[i];
        if (!(e.x > 0 && e.y > 0 && e.z > 0))
            return fail(MERLIN_BAD_INPUT,
                        "%s:%d: the light has no red, green or blue (an intensity of 0); stereo wants all three of "
                        "every light",
                        path, list->line[i]);
        vec3_put(e, c->light[i].intensity);
        c->intensities_listed = true;
    }
    return OK;
}

status pst_set_lights(const char *path, const light_list *list, const merlin_capture_files *options, merlin_capture *c)
{
    c->lighting = options->near_lights ? MERLIN_NEAR_LIGHTS : MERLIN_DISTANT_LIGHTS;
    c->intensities_known = true; /* a list of lights without intensities means equal ones */
    status s = set_intensities(path, list, c);
    if (s != OK) return s;
    if (list->note[0]) warnings_add(&c->noticed, "lights_list", "%s: %s", path, list->note);
    return options->near_lights ? set_positions(path, list, c) : set_directions(path, list, c);
}

status pst_read_light_list(const char *folder, const char *lights, const merlin_capture_files *options,
                           merlin_capture *c)
{
    light_list list;
    status s = light_list_read(lights, &list);
    if (s != OK) return s;
    s = pst_match_lights(folder, options, lights, &list, c);
    if (s == OK) s = pst_set_lights(lights, &list, options, c);
    if (s == OK) s = pst_read_strengths(folder, lights, list.intensity, c);
    light_list_free(&list);
    return s;
}

/* Reads pictures of which no list of lights is used. */
static status read_unlit(const char *folder, const merlin_capture_files *options, merlin_capture *c)
{
    status s = pst_take_pictures(folder, false, options, NULL, 0, c);
    return s == OK ? pst_read_strengths(folder, NULL, false, c) : s;
}

status pst_read_plain(const char *folder, const merlin_capture_files *options, merlin_capture *c)
{
    char *lights = NULL;
    if (options->unknown_lights) return read_unlit(folder, options, c);
    status s = find_lights(folder, options->lights, &lights);
    if (s == OK && !lights && options->lights_optional && !options->near_lights) {
        s = read_unlit(folder, options, c);
        c->lighting = MERLIN_UNKNOWN_LIGHTS;
        return s;
    }
    if (s == OK && !lights) s = pst_check_pictures(folder, options);
    if (s == OK && !lights)
        return fail(MERLIN_BAD_INPUT,
                    "%s says nothing of its lights (no lights.txt, .lp, LUCES or DiLiGenT files); name the file that "
                    "holds them, or give --method universal or uncalibrated, which find them",
                    folder);
    if (s == OK) s = pst_read_light_list(folder, lights, options, c);
    if (s == OK && !options->lights) s = check_other_lists(folder, lights, c);
    free(lights);
    return s;
}
