/* SPDX-License-Identifier: MIT */
#include "cli/relight/lamps.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/lights/light_list.h"
#include "command/cli.h"

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

merlin_lamp lamp_in_style(merlin_lamp lamp, const lamp_style *style)
{
    vec3_put(vec3_scale(style->color, style->power), lamp.power);
    return lamp;
}

static status add(lamp_options *lamps, merlin_lamp l)
{
    if (lamps->count >= LIGHT_LIST_MAX) return fail(MERLIN_BAD_INPUT, "more than %d lights", LIGHT_LIST_MAX);
    size_t more = lamps->count + 1;
    merlin_lamp *at = realloc(lamps->at, more * sizeof *at);
    if (at) lamps->at = at;
    lamp_style *style = at ? realloc(lamps->style, more * sizeof *style) : NULL;
    if (!style) return fail(MERLIN_NO_MEMORY, "no memory for %zu lights", more);
    lamps->style = style;
    style[lamps->count] = lamps->common;
    style[lamps->count].has_power = style[lamps->count].has_color = false;
    lamps->at[lamps->count++] = lamp_in_style(l, &lamps->common);
    return OK;
}

status lamp_take_light(const char *text, void *into)
{
    float v[3];
    status s = cli_vec3("--light", text, v);
    return s == OK ? add(into, merlin_lamp_at(v[0], v[1], v[2])) : s;
}

static status check_direction(const char *option, vec3 direction)
{
    float length = vec3_length(direction);
    if (length > 1e-6f && length < 1e18f) return OK;
    return fail(MERLIN_WRONG_USE, "%s: the direction %s", option, length > 1 ? "is too long" : "has no length");
}

status lamp_take_direction(const char *text, void *into)
{
    float v[3];
    status s = cli_vec3("--direction", text, v);
    if (s == OK) s = check_direction("--direction", vec3_of(v));
    return s == OK ? add(into, merlin_lamp_toward(v[0], v[1], v[2])) : s;
}

/* Returns the style that an option at this position changes. */
static lamp_style *style_here(lamp_options *lamps)
{
    return lamps->count ? &lamps->style[lamps->count - 1] : &lamps->common;
}

static void restyle(lamp_options *lamps)
{
    const size_t last = lamps->count - 1;
    if (lamps->count) lamps->at[last] = lamp_in_style(lamps->at[last], &lamps->style[last]);
}

/* Records that an option was given; it may be given once per lamp, and once for all lamps without their own. */
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
    static const merlin_pixel_layout one = {.width = 1, .height = 1, .channels = 3, .type = MERLIN_PIXEL_FLOAT};
    if (*text++ != '#' || strlen(text) != 6) return false;
    float encoded[3];
    for (int c = 0; c < 3; c++) {
        char digits[3] = {text[2 * c], text[2 * c + 1], 0};
        if (!isxdigit((unsigned char)digits[0]) || !isxdigit((unsigned char)digits[1])) return false;
        encoded[c] = (float)strtol(digits, NULL, 16) / 255;
    }
    merlin_image pixel;
    if (merlin_image_from_pixels(encoded, &one, &pixel, NULL) != MERLIN_OK) return false;
    *color = vec3_of(pixel.data);
    merlin_image_free(&pixel);
    return true;
}

static bool take_kelvin(const char *text, vec3 *color)
{
    char *end;
    double kelvin = strtod(text, &end);
    if (end == text || (*end != 'K' && *end != 'k') || end[1]) return false;
    float channel[3];
    if (merlin_temperature_color(kelvin, channel) != MERLIN_OK) return false;
    *color = vec3_of(channel);
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

/* Adds a listed lamp, as strong as it is listed times the common style. */
static status add_listed(const merlin_lamp *lamp, lamp_options *lamps)
{
    status s = add(lamps, *lamp);
    if (s != OK) return s;
    lamp_style *style = &lamps->style[lamps->count - 1];
    style->color = vec3_mul(style->color, vec3_of(lamp->power));
    restyle(lamps);
    return OK;
}

status lamp_read_list(const char *path, float near, lamp_options *lamps)
{
    merlin_lamps list;
    status s = merlin_lamps_read(path, near, &list);
    if (s != OK) return s;
    lamps->noticed = list.warnings;
    for (size_t i = 0; i < list.count && s == OK; i++)
        s = add_listed(&list.at[i], lamps);
    merlin_lamps_free(&list);
    return s;
}
