/* SPDX-License-Identifier: MIT */
/* Makes a picture's codes linear light in sRGB's primaries: by the curve and the primaries that the file states,
 * by sRGB's where it states none.
 *
 *     picture_light light = {.said = false};                                  sRGB, because nothing says otherwise
 *     if (!picture_light_of_cicp(9, 16, &light)) refuse;                      BT.2020 and PQ
 *     float *linear = picture_light_table(&light, true);                      linear[code], in the file's primaries
 */
#ifndef MERLIN_IMAGE_METADATA_PICTURE_LIGHT_H
#define MERLIN_IMAGE_METADATA_PICTURE_LIGHT_H

#include <stdbool.h>
#include <stdint.h>

#include "base/status.h"

typedef enum picture_curve {
    PICTURE_CURVE_SRGB,
    PICTURE_CURVE_POWER, /* light is the code to the exponent's power */
    PICTURE_CURVE_BT709, /* of televisions: light before the camera */
    PICTURE_CURVE_PQ,    /* SMPTE ST 2084: 1 is a white of 203 cd/m², as ITU-R BT.2408 has it */
    PICTURE_CURVE_HLG,   /* ITU-R BT.2100: 1 is that white, at three quarters of the codes */
} picture_curve;

/* Zero-initialized: sRGB, unsaid. */
typedef struct picture_light {
    bool said; /* the file states the curve itself */
    picture_curve curve;
    float exponent;
    bool narrow;        /* codes reach from 16 to 235 of 255, not from 0 */
    bool has_primaries; /* xy: of red, green, blue and white, other than sRGB's */
    float xy[8];
} picture_light;

static inline picture_light picture_light_of_power(float exponent)
{
    return (picture_light){.said = true, .curve = PICTURE_CURVE_POWER, .exponent = exponent};
}

/* States the primaries, unless they are sRGB's. */
void picture_light_set_primaries(const float xy[8], picture_light *light);

/* By the numbers of ITU-T H.273 that PNG's cICP, HEIF's nclx and others share; 2, unspecified, says nothing. False for
 * a number that is reserved or whose curve is none of those above. */
bool picture_light_of_cicp(int primaries, int transfer, picture_light *light);

/* Adobe RGB (1998). */
picture_light picture_light_of_adobe_rgb(void);

/* Tells whether light goes beyond 1, so that it has a unit of its own as floats have. */
static inline bool picture_light_is_bright(const picture_light *light)
{
    return light->curve == PICTURE_CURVE_PQ || light->curve == PICTURE_CURVE_HLG;
}

/* Linear light of a float, in the file's primaries; what is below 0 or beyond 1 goes on as the curve does. */
float picture_light_of_float(const picture_light *light, float value);

/* Linear light, in the file's primaries, of all codes of 8 or 16 (wide) bits, whose owner frees it; NULL without
 * memory. */
float *picture_light_table(const picture_light *light, bool wide);

#endif
