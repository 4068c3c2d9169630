/* SPDX-License-Identifier: MIT */
/* Lists of lights from text, as people, spreadsheets and programs write them (docs/light_lists.md).
 *
 *     light_list lights;
 *     status s = light_list_read("dome.lp", &lights);
 *     for (size_t i = 0; i < lights.count; i++) use(lights.at[i]);
 *     light_list_free(&lights);
 *
 * A light is `x y z` a line: a place in the camera's space or a direction, as whoever reads the list has it; before or
 * behind the numbers may stand a picture's name or a light's number, and behind them how strong the light is, once or
 * for red, green and blue. The RTI world's .lp begins with a count, and is about the object, z toward the camera. Three
 * lines of more than three numbers are x, y and z of a light in each column. A line of words before the numbers may
 * name columns, in any order, also `azimuth` and `elevation`. */
#ifndef MERLIN_BASE_LIGHTS_LIGHT_LIST_H
#define MERLIN_BASE_LIGHTS_LIGHT_LIST_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"
#include "base/vec.h"

enum { LIGHT_LIST_MAX = 4096, LIGHT_LIST_NOTE = 256 };

/* Names by which a folder's list of lights is found, up to NULL; an .lp file may have any. */
extern const char *const light_list_names[];

/* The first words of a list that merlin stereo calibrate has written, by which its own is known again. */
#define LIGHT_LIST_OF_CALIBRATION "# Directions to the lights, found from"

typedef struct light_list {
    vec3 *at;                   /* x y z as they stand; from angles of unit length, or the listed distance */
    char **name;                /* what stands beside the numbers: a picture's name, a number; NULL: nothing does */
    vec3 *intensity;            /* NULL: the list does not say */
    int *line;                  /* of the file, from 1 on */
    bool about_object;          /* the file's name ends in .lp, or it begins with a count */
    bool angles;                /* directions for sure */
    char note[LIGHT_LIST_NOTE]; /* what should be known of how the list was understood; "" if nothing */
    size_t count;
} light_list;

/* Refuses values that are no numbers, not finite or beyond ±1e6, lights of an .lp file and of angles without a
 * direction, a count that does not fit, no lights and more than LIGHT_LIST_MAX; messages carry the line's number. */
status light_list_read(const char *path, light_list *out);
/* The same from bytes (need not end in a zero); `where` is put in front of messages. */
status light_list_parse(const char *text, size_t size, const char *where, light_list *out);
void light_list_free(light_list *list);

/* The unit direction of what stands in entry i; 0, 0, 0 if it has none. */
static inline vec3 light_list_direction(const light_list *list, size_t i)
{
    return vec3_normalize(list->at[i]);
}

/* Tells whether all entries are of length 1, as directions are, and as places hardly ever. */
bool light_list_is_unit(const light_list *list);

#endif
