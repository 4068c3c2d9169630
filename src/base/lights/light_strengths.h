/* SPDX-License-Identifier: MIT */
/* Lights' intensities in a file of their own: one number a light, or three, or a light in each column.
 *
 *     char *path;
 *     status s = light_strengths_find(folder, "lights.txt", false, &path);
 *     if (s == OK && path) s = light_strengths_read(path, &(light_strengths){.count = n, .value = intensity, ...});
 */
#ifndef MERLIN_BASE_LIGHTS_LIGHT_STRENGTHS_H
#define MERLIN_BASE_LIGHTS_LIGHT_STRENGTHS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

/* The lights whose intensities are read. */
typedef struct light_strengths {
    size_t count;
    float (*value)[3]; /* count: red, green, blue */
    /* sets the light that a picture's name stands for, `count` if there is none */
    status (*find)(void *context, const char *name, size_t *light);
    void *context;
    const char *where; /* what has these pictures, for messages */
} light_strengths;

/* Finds light_intensities.txt or a file with a similar name in the folder or next to the list of lights (NULL: there is
 * none); *path is NULL if there is none. Free it. listed: whether the list says how strong they are itself.
 * MERLIN_BAD_INPUT if two do. */
status light_strengths_find(const char *folder, const char *lights, bool listed, char **path);

/* Reads them. MERLIN_BAD_INPUT for what are no numbers above 0, names that `find` does not know, a light twice, and
 * another number than of lights. */
status light_strengths_read(const char *path, const light_strengths *of);

#endif
