/* SPDX-License-Identifier: MIT */
/* The lamps of a command line, with their power and colour.
 *
 *     lamp_options lamps = lamp_options_new();
 *     {"light", .take = lamp_take_light, .into = &lamps}, {"direction", .take = lamp_take_direction, .into = &lamps},
 *     {"power", .take = lamp_take_power, .into = &lamps}, {"color", .take = lamp_take_color, .into = &lamps},
 *
 * Power and colour after a lamp are its own; those before the first apply to all lamps without their own. */
#ifndef MERLIN_CLI_RELIGHT_LAMPS_H
#define MERLIN_CLI_RELIGHT_LAMPS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"
#include "base/vec.h"
#include "base/warnings.h"
#include "merlin/lights.h"

typedef struct lamp_style {
    float power;               /* factor of the power of the training data's lamp */
    vec3 color;                /* linear sRGB */
    bool has_power, has_color; /* whether it has its own options, not those before the first lamp */
} lamp_style;

typedef struct lamp_options {
    merlin_lamp *at;
    lamp_style *style; /* style of each */
    size_t count;
    warnings noticed;  /* warnings about the list that was read */
    lamp_style common; /* style of further lamps: of a list, a dome and an orbit */
} lamp_options;

lamp_options lamp_options_new(void);
void lamp_options_free(lamp_options *lamps);

/* Take an option's value, for rows of command/options.h; into is a lamp_options. A position or a direction, "x,y,z"; a
 * factor; "r,g,b", "#rrggbb" or "2700K". */
status lamp_take_light(const char *text, void *into);
status lamp_take_direction(const char *text, void *into);
status lamp_take_power(const char *text, void *into);
status lamp_take_color(const char *text, void *into);

/* Adds the lights of a file, with its intensities: positions, x y z per line; or directions, from an .lp file or as
 * angles, whose lights are distant or, if near is not 0, at this distance from (0, 0, -1), where the object is. */
status lamp_read_list(const char *path, float near, lamp_options *lamps);
/* Gives a lamp the power and colour of a style. */
merlin_lamp lamp_in_style(merlin_lamp lamp, const lamp_style *style);

#endif
