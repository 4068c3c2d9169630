/* SPDX-License-Identifier: MIT */
#include "cli/relight/lamps.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/lights/light_list.h"
#include "command/cli.h"
#include "image/color.h"
#include "optics/blackbody.h"

lamp_options lamp_options_new(void)
{
    return (lamp_options){.common = {.power = 1, .color = {1, 1, 1}}};
}

void lamp_options_free(lamp_options *lamps)
{
    free(lamps->at);
    free(lamps->style);
    *lamps = (lamp_options){0};
}

vec3 lamp_tint(const lamp_style *style)
{
    return vec3_scale(style->color, style->power);
}

static status add(lamp_options *lamps, lamp l)
{
    if (lamps->count >= LIGHT_LIST_MAX) return fail(MERLIN_BAD_INPUT, "more than %d lights", LIGHT_LIST_MAX);
    size_t more = lamps->count + 1;
    lamp *at = realloc(lamps->at, more * sizeof *at);
    if (at) lamps->at = at;
    lamp_style *style = at ? realloc(lamps->style, more * sizeof *style) : NULL;
    if (!style) return fail(MERLIN_NO_MEMORY, "no memory for %zu lights", more);
    lamps->style = style;
    l.tint = lamp_tint(&lamps->common);
    style[lamps->count] = lamps->common;
    style[lamps->count].has_power = style[lamps->count].has_color = false;
    lamps->at[lamps->count++] = l;
    return OK;
}

status lamp_take_light(const char *text, void *into)
{
    float v[3];
    status s = cli_vec3("--light", text, v);
    return s == OK ? add(into, lamp_at(vec3_of(v))) : s;
}

static status check_direction(const char *option, vec3 direction)
{
    float length = vec3_length(direction);
    if (length > 1e-6f && length < 1e18f) return OK;
    return fail(MERLIN_WRONG_USE, "%s: the direction has no length", option);
}

status lamp_take_direction(const char *text, void *into)
{
    float v[3];
    status s = cli_vec3("--direction", text, v);
    if (s == OK) s = check_direction("--direction", vec3_of(v));
    return s == OK ? add(into, lamp_toward(vec3_of(v))) : s;
}

/* The style that an option behind the lamps so far changes. */
static lamp_style *style_here(lamp_options *lamps)
{
    return lamps->count ? &lamps->style[lamps->count - 1] : &lamps->common;
}

static void restyle(lamp_options *lamps)
{
    if (lamps->count) lamps->at[lamps->count - 1].tint = lamp_tint(&lamps->style[lamps->count - 1]);
}

/* Notes that an option was given, which it may be once for a lamp, and once for all that have none of their own. */
static status mark(bool *given, const char *option)
{
    if (*given) return fail(MERLIN_WRONG_USE, "%s is given twice for the same lamps", option);
    *given = true;
    return OK;
}

status lamp_take_power(const char *text, void *into)
{
    double power;
    status s = cli_float("--power", text, 1e-3, 1e6, &power);
    if (s != OK) return s;
    s = mark(&style_here(into)->has_power, "--power");
    if (s != OK) return s;
    style_here(into)->power = (float)power;
    restyle(into);
    return OK;
}

static bool take_hex(const char *text, vec3 *color)
{
    if (*text++ != '#' || strlen(text) != 6) return false;
    float channel[3];
    for (int c = 0; c < 3; c++) {
        char digits[3] = {text[2 * c], text[2 * c + 1], 0};
        if (!isxdigit((unsigned char)digits[0]) || !isxdigit((unsigned char)digits[1])) return false;
        channel[c] = srgb_decode((float)strtol(digits, NULL, 16) / 255);
    }
    *color = vec3_of(channel);
    return true;
}

static bool take_kelvin(const char *text, vec3 *color)
{
    char *end;
    double kelvin = strtod(text, &end);
    if (end == text || (*end != 'K' && *end != 'k') || end[1] || !(kelvin >= 1000 && kelvin <= 40000)) return false;
    *color = blackbody_color(kelvin);
    return true;
}

static bool take_numbers(const char *text, vec3 *color)
{
    float v[3];
    if (cli_vec3("--color", text, v) != OK) return false;
    *color = vec3_of(v);
    return v[0] >= 0 && v[1] >= 0 && v[2] >= 0 && v[0] + v[1] + v[2] < 1e6f;
}

status lamp_take_color(const char *text, void *into)
{
    vec3 color;
    if (!take_hex(text, &color) && !take_kelvin(text, &color) && !take_numbers(text, &color))
        return fail(MERLIN_WRONG_USE,
                    "--color wants linear r,g,b, or #rrggbb as in sRGB, or a temperature from 1000K to 40000K, not "
                    "\"%s\"",
                    text);
    if (!(color.x + color.y + color.z > 0)) return fail(MERLIN_WRONG_USE, "--color %s is black: no light", text);
    status s = mark(&style_here(into)->has_color, "--color");
    if (s != OK) return s;
    style_here(into)->color = color;
    restyle(into);
    return OK;
}

/* The directions of other programs' lists would be places behind the camera. */
static void note_list(const char *path, const light_list *list, lamp_options *lamps)
{
    bool behind = list->count > 1 && !list->about_object && !list->angles && light_list_is_unit(list);
    for (size_t i = 0; i < list->count && behind; i++)
        behind = list->at[i].z > 0;
    if (behind)
        warnings_add(&lamps->noticed, "lights_behind_camera",
                     "the lights in %s are all of length 1 and behind the camera (z above 0), as directions are, and "
                     "were taken for places: an .lp file lists directions",
                     path);
    if (list->note[0]) warnings_add(&lamps->noticed, "lights_list", "%s: %s", path, list->note);
}

static status add_listed(const light_list *list, size_t i, float near, lamp_options *lamps)
{
    const vec3 object = {0, 0, -1};
    vec3 direction = light_list_direction(list, i);
    lamp l = lamp_at(list->at[i]);
    if (list->about_object || list->angles)
        l = near > 0 ? lamp_at(vec3_fma(object, near, direction)) : lamp_toward(direction);
    status s = add(lamps, l);
    if (s != OK || !list->intensity) return s;
    lamp_style *style = &lamps->style[lamps->count - 1];
    style->color = vec3_mul(style->color, list->intensity[i]);
    restyle(lamps);
    return OK;
}

status lamp_read_list(const char *path, float near, lamp_options *lamps)
{
    light_list list;
    status s = light_list_read(path, &list);
    if (s != OK) return s;
    note_list(path, &list, lamps);
    for (size_t i = 0; i < list.count && s == OK; i++)
        s = add_listed(&list, i, near, lamps);
    light_list_free(&list);
    return s;
}
