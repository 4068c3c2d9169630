/* SPDX-License-Identifier: MIT */
/* The light that a photograph is lit by, in words for a person. */
#include <math.h>
#include <stdio.h>

#include "estimate/light/found_light.h"
#include "optics/camera.h"

static const float NAMED = 1 / 7.0f;
enum { LAMP_WORDS = 96 }; /* length of a lamp's words, which leaves room for the rest */

/* One within 5 degrees is called next to the lens. */
int merlin_lamp_words(const float direction[3], char *text, int size)
{
    const size_t room = size > 0 ? (size_t)size : 0;
    const float right = direction[0], up = direction[1], aside = hypotf(right, up);
    const int degrees = (int)lrintf(atan2f(aside, direction[2]) / DEGREE);
    const bool upright = fabsf(up) > 0.38f * aside, sideways = fabsf(right) > 0.38f * aside; /* sine of 22.5 degrees */
    const char *vertical = up > 0 ? sideways ? "upper " : "above" : sideways ? "lower " : "below";
    if (degrees < 5) return snprintf(text, room, "a lamp by the lens");
    return snprintf(text, room, "a lamp from %s%s%s, %d degrees aside", sideways ? "the " : "", upright ? vertical : "",
                    sideways ? right > 0 ? "right" : "left" : "", degrees);
}

int merlin_light_words(const merlin_found_light *light, char *text, int size)
{
    const found_light_shares share = found_light_share(light);
    char of_lamp[LAMP_WORDS] = "";
    const bool flash = share.flash >= NAMED, beam = share.lamp >= NAMED, rest = share.rest >= NAMED;
    const size_t room = size > 0 ? (size_t)size : 0;
    if (beam) merlin_lamp_words(light->lamp, of_lamp, sizeof of_lamp);
    if (flash && !beam && !rest && !found_light_is_flash(light))
        return snprintf(text, room, "a flash and a little other light");
    if (light->known && !flash && !beam && !rest) return snprintf(text, room, "light of an unknown kind");
    return snprintf(text, room, "%s%s%s%s", flash ? "a flash" : "", flash && beam ? " and " : "", of_lamp,
                    !rest           ? ""
                    : flash || beam ? ", in a room"
                                    : "a room's light");
}
