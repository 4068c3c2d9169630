/* SPDX-License-Identifier: MIT */
/* The lamps of a command line, and how bright and of what colour they are.
 *
 *     lamp_options lamps = lamp_options_new();
 *     {"light", .take = lamp_take_light, .into = &lamps}, {"direction", .take = lamp_take_direction, .into = &lamps},
 *     {"power", .take = lamp_take_power, .into = &lamps}, {"color", .take = lamp_take_color, .into = &lamps},
 *
 * Power and colour that follow a lamp are its own; those before the first are for all that have none of their own. */
#ifndef MERLIN_CLI_RELIGHT_LAMPS_H
#define MERLIN_CLI_RELIGHT_LAMPS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"
#include "base/vec.h"
#include "base/warnings.h"
#include "merlin/lights.h"

typedef struct lamp_style {
    float power;               /* times that of the training data's lamp */
    vec3 color;                /* linear sRGB */
    bool has_power, has_color; /* its own options, not those before the first lamp */
} lamp_style;

typedef struct lamp_options {
    merlin_lamp *at;
    lamp_style *style; /* of each */
    size_t count;
    warnings noticed;  /* of the list that was read */
    lamp_style common; /* of those that follow, of a list's, a dome's and an orbit's */
} lamp_options;

lamp_options lamp_options_new(void);
void lamp_options_free(lamp_options *lamps);

/* Take an option's value, for rows of command/options.h; into is a lamp_options. A place or a direction, "x,y,z"; a
 * factor; "r,g,b", "#rrggbb" or "2700K". */
status lamp_take_light(const char *text, void *into);
status lamp_take_direction(const char *text, void *into);
status lamp_take_power(const char *text, void *into);
status lamp_take_color(const char *text, void *into);

/* Adds the lights of a file, as strong as it says: places, x y z a line; or directions, of an .lp file or as angles,
 * whose lights are distant or, where near is not 0, so far from (0, 0, -1), where the object is. */
status lamp_read_list(const char *path, float near, lamp_options *lamps);
/* Gives a lamp the power and colour of a style. */
merlin_lamp lamp_in_style(merlin_lamp lamp, const lamp_style *style);

#endif
