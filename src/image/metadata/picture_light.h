/* SPDX-License-Identifier: MIT */
/* Decodes a picture's codes to linear light in sRGB's primaries: by the curve and the primaries that the file states,
 * by sRGB's if it states none.
 *
 *     picture_light light = {.said = false};                                  sRGB, as nothing is stated
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
    PICTURE_CURVE_POWER, /* light is the code to the power of the exponent */
    PICTURE_CURVE_BT709, /* television: scene light */
    PICTURE_CURVE_PQ,    /* SMPTE ST 2084: 1 is a white of 203 cd/m², as ITU-R BT.2408 has it */
    PICTURE_CURVE_HLG,   /* ITU-R BT.2100: 1 is that white, at three quarters of the codes */
} picture_curve;

/* What a file states about its codes. Zero-initialized: nothing, so that sRGB is assumed. */
typedef struct picture_light {
    bool said; /* the file states the curve itself */
    picture_curve curve;
    float exponent;
    bool narrow;        /* codes range from 16 to 235 of 255, not from 0 */
    bool has_primaries; /* xy: chromaticities of red, green, blue and white, other than sRGB's */
    float xy[8];
} picture_light;

static inline picture_light picture_light_of_power(float exponent)
{
    return (picture_light){.said = true, .curve = PICTURE_CURVE_POWER, .exponent = exponent};
}

/* Sets the primaries, unless they are sRGB's. */
void picture_light_set_primaries(const float xy[8], picture_light *light);

/* Sets curve and primaries by the code points of ITU-T H.273, which PNG's cICP, HEIF's nclx and others share; 2,
 * unspecified, sets nothing. Returns false for a reserved number or a curve that is none of the above. */
bool picture_light_of_cicp(int primaries, int transfer, picture_light *light);

/* Returns the light of Adobe RGB (1998). */
picture_light picture_light_of_adobe_rgb(void);

/* Tells whether values go beyond 1, so that they have a unit of their own as floats have. */
static inline bool picture_light_is_bright(const picture_light *light)
{
    return light->curve == PICTURE_CURVE_PQ || light->curve == PICTURE_CURVE_HLG;
}

/* Decodes a float to linear light in the file's primaries; values below 0 or above 1 extend the curve. */
float picture_light_of_float(const picture_light *light, float value);

/* Returns the linear light, in the file's primaries, of all codes of 8 or 16 (wide) bits; the caller frees it. NULL
 * without memory. */
float *picture_light_table(const picture_light *light, bool wide);

#endif
