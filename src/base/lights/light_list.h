/* SPDX-License-Identifier: MIT */
/* Lists of lights in text files, as people, spreadsheets and programs write them (docs/light_lists.md).
 *
 *     light_list lights;
 *     status s = light_list_read("dome.lp", &lights);
 *     for (size_t i = 0; i < lights.count; i++) use(lights.at[i]);
 *     light_list_free(&lights);
 *
 * A light is a line `x y z`: a position in camera space or a direction, which the caller decides. A picture's name or a
 * light's number may stand before or after the numbers, and after them the intensity, once or for red, green and blue.
 * An .lp file of RTI tools begins with a count; its axes are the object's, z toward the camera. Three lines of more
 * than three numbers each are the x, y and z of one light a column. A line of words before the numbers may name the
 * columns, in any order, also `azimuth` and `elevation`. */
#ifndef MERLIN_BASE_LIGHTS_LIGHT_LIST_H
#define MERLIN_BASE_LIGHTS_LIGHT_LIST_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"
#include "base/vec.h"

enum { LIGHT_LIST_MAX = 4096, LIGHT_LIST_NOTE = 256 };

/* Names by which a folder's list of lights is found, up to NULL; an .lp file may have any. */
extern const char *const light_list_names[];
/* Tells whether a file's name is one of these, in any case, or ends in .lp. */
bool light_list_is_name(const char *name);

/* The first words of a list that merlin stereo calibrate has written, by which its own is known again. */
#define LIGHT_LIST_OF_CALIBRATION "# Directions to the lights, found from"

typedef struct light_list {
    vec3 *at;                   /* x y z as written; from angles: of unit length, or of the listed distance */
    char **name;                /* word beside the numbers, a picture's name or a number; NULL if there is none */
    vec3 *intensity;            /* NULL if the list has none */
    int *line;                  /* line numbers in the file, from 1 */
    bool about_object;          /* the file's name ends in .lp, or it begins with a count */
    bool angles;                /* given by angles, so certainly directions */
    char note[LIGHT_LIST_NOTE]; /* how the list was interpreted, where a user should know; "" if there is nothing to say
                                 */
    size_t count;
} light_list;

/* Reads a list from a file. Refuses words in place of numbers, values not finite or beyond ±1e6, lights of an .lp file
 * or of angles without a direction, a count that does not match, empty lists and more than LIGHT_LIST_MAX lights;
 * messages carry the line's number. */
status light_list_read(const char *path, light_list *out);
/* Reads a list from bytes, which need not end in a zero; `where` is put in front of messages. */
status light_list_parse(const char *text, size_t size, const char *where, light_list *out);
void light_list_free(light_list *list);

/* Returns the unit direction of entry i; 0, 0, 0 if it has none. */
static inline vec3 light_list_direction(const light_list *list, size_t i)
{
    return vec3_normalize(list->at[i]);
}

/* Tells whether all entries have length 1, as directions do and positions hardly ever. */
bool light_list_is_unit(const light_list *list);

#endif
