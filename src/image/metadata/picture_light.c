/* SPDX-License-Identifier: MIT */
#include "image/metadata/picture_light.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "image/color.h"
#include "image/primaries.h"

static const float WHITE_XY[2] = {0.3127f, 0.3290f};

void picture_light_set_primaries(const float xy[8], picture_light *light)
{
    light->has_primaries = !primaries_are_srgb(xy);
    memcpy(light->xy, xy, sizeof light->xy);
}

/* Returns the primaries of a number in ITU-T H.273, table 2, except sRGB's own. */
static bool primaries_of_number(int number, float xy[8])
{
    static const struct {
        int number;
        float xy[8];
    } known[] = {
        {4, {0.67f, 0.33f, 0.21f, 0.71f, 0.14f, 0.08f, 0.310f, 0.316f}},
        {5, {0.64f, 0.33f, 0.29f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f}},
        {6, {0.630f, 0.340f, 0.310f, 0.595f, 0.155f, 0.070f, 0.3127f, 0.3290f}},
        {7, {0.630f, 0.340f, 0.310f, 0.595f, 0.155f, 0.070f, 0.3127f, 0.3290f}},
        {8, {0.681f, 0.319f, 0.243f, 0.692f, 0.145f, 0.049f, 0.310f, 0.316f}},
        {9, {0.708f, 0.292f, 0.170f, 0.797f, 0.131f, 0.046f, 0.3127f, 0.3290f}},
        {10, {1, 0, 0, 1, 0, 0, 1 / 3.0f, 1 / 3.0f}},
        {11, {0.680f, 0.320f, 0.265f, 0.690f, 0.150f, 0.060f, 0.314f, 0.351f}},
        {12, {0.680f, 0.320f, 0.265f, 0.690f, 0.150f, 0.060f, 0.3127f, 0.3290f}},
        {22, {0.630f, 0.340f, 0.295f, 0.605f, 0.155f, 0.077f, 0.3127f, 0.3290f}},
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        if (known[i].number != number) continue;
        memcpy(xy, known[i].xy, sizeof known[i].xy);
        return true;
    }
    return false;
}

static bool set_transfer(int number, picture_light *light)
{
    light->said = number != 2;
    light->exponent = number == 4 ? 2.2f : number == 5 ? 2.8f : 1;
    switch (number) {
    case 2:
    case 13:
        light->curve = PICTURE_CURVE_SRGB;
        return true;
    case 1:
    case 6:
    case 14:
    case 15:
        light->curve = PICTURE_CURVE_BT709;
        return true;
    case 4:
    case 5:
    case 8:
        light->curve = PICTURE_CURVE_POWER;
        return true;
    case 16:
        light->curve = PICTURE_CURVE_PQ;
        return true;
    case 18:
        light->curve = PICTURE_CURVE_HLG;
        return true;
    default:
        return false;
    }
}

bool picture_light_of_cicp(int primaries, int transfer, picture_light *light)
{
    float xy[8];
    bool srgb = primaries == 1 || primaries == 2;
    *light = (picture_light){.said = false};
    if (!set_transfer(transfer, light) || (!srgb && !primaries_of_number(primaries, xy))) return false;
    if (!srgb) picture_light_set_primaries(xy, light);
    return true;
}

picture_light picture_light_of_adobe_rgb(void)
{
    picture_light light = picture_light_of_power(563 / 256.0f);
    picture_light_set_primaries((const float[8]){0.64f, 0.33f, 0.21f, 0.71f, 0.15f, 0.06f, WHITE_XY[0], WHITE_XY[1]},
                                &light);
    return light;
}

static double decode_bt709(double v)
{
    return v < 0.081 ? v / 4.5 : pow((v + 0.099) / 1.099, 1 / 0.45);
}

static double decode_pq(double v)
{
    const double m1 = 2610 / 16384.0, m2 = 2523 / 32.0, c1 = 3424 / 4096.0, c2 = 2413 / 128.0, c3 = 2392 / 128.0;
    const double white = 203 / 10000.0;
    double p = pow(v, 1 / m2);
    return pow(fmax(p - c1, 0) / (c2 - c3 * p), 1 / m1) / white;
}

static double decode_hlg(double v)
{
    const double a = 0.17883277, b = 0.28466892, c = 0.55991073, white = (exp((0.75 - c) / a) + b) / 12;
    return (v <= 0.5 ? v * v / 3 : (exp((v - c) / a) + b) / 12) / white;
}

/* Decodes a code v. eighths: the largest code in units of 1/255 of the 8-bit range: 255, or for 16 bits a little less
 * than 256. */
static double decode(const picture_light *light, double v, double eighths)
{
    if (light->narrow) v = fmin(fmax((eighths * v - 16) / 219, 0), 1);
    switch (light->curve) {
    case PICTURE_CURVE_POWER:
        return light->exponent == 1 ? v : pow(v, (double)light->exponent);
    case PICTURE_CURVE_BT709:
        return decode_bt709(v);
    case PICTURE_CURVE_PQ:
        return decode_pq(v);
    case PICTURE_CURVE_HLG:
        return decode_hlg(v);
    case PICTURE_CURVE_SRGB:
        break;
    }
    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

float picture_light_of_float(const picture_light *light, float value)
{
    return copysignf((float)decode(light, fabs((double)value), 255), value);
}

float *picture_light_table(const picture_light *light, bool wide)
{
    size_t count = wide ? 65536 : 256;
    float *table = malloc(count * sizeof *table);
    if (!table) return NULL;
    if (light->curve == PICTURE_CURVE_SRGB && !light->narrow)
        return memcpy(table, wide ? srgb_decode_table16() : srgb_decode_table8(), count * sizeof *table);
    for (size_t i = 0; i < count; i++)
        table[i] = (float)decode(light, (double)i / (double)(count - 1), wide ? 65535 / 256.0 : 255);
    return table;
}
