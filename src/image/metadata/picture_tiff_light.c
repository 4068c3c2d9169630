/* SPDX-License-Identifier: MIT */
#include "image/metadata/picture_tiff_light.h"

#include <math.h>
#include <string.h>

#include "image/color.h"
#include "image/metadata/exif.h"
#include "image/primaries.h"

/* Returns how far a curve is from the table's entries at a quarter, a half and three quarters. */
static double distance(const double v[3], const double y[3], double exponent)
{
    double most = 0;
    for (int i = 0; i < 3; i++)
        most = fmax(most, fabs(y[i] - (exponent > 0 ? pow(v[i], exponent) : (double)srgb_decode((float)v[i]))));
    return most;
}

static status find_curve(const tiff_head *t, uint64_t page, const char *path, picture_light *light)
{
    const double near = 0.01;
    uint64_t codes = 1ULL << (tiff_value(t, page, TIFF_BITS) & 31), count = tiff_count(t, page, TIFF_TRANSFER);
    double v[3], y[3];
    if (count != codes && count != 3 * codes) return OK; /* a length that TIFF does not define */
    for (uint64_t i = 0; i < 3; i++) {
        uint64_t at = codes * (i + 1) / 4;
        v[i] = (double)at / (double)(codes - 1);
        y[i] = tiff_value_at(t, page, TIFF_TRANSFER, at) / 65535.0;
    }
    double exponent = y[1] > 0 && y[1] < 1 ? log(y[1]) / log(v[1]) : 0;
    light->said = true;
    if (distance(v, y, 0) < near) return OK;
    if (!(exponent > 0) || distance(v, y, exponent) >= near)
        return fail(MERLIN_BAD_INPUT,
                    "cannot read %s: its TransferFunction is no curve that is known here; save it as sRGB", path);
    light->curve = PICTURE_CURVE_POWER;
    light->exponent = (float)exponent;
    return OK;
}

static void find_primaries(const tiff_head *t, uint64_t page, picture_light *light)
{
    float xy[8] = {[6] = 0.3127f, [7] = 0.3290f};
    double m[9];
    if (tiff_count(t, page, TIFF_PRIMARIES) != 6) return;
    for (uint64_t i = 0; i < 6; i++)
        xy[i] = (float)tiff_real_at(t, page, TIFF_PRIMARIES, i);
    for (uint64_t i = 0; i < 2 && tiff_count(t, page, TIFF_WHITE) == 2; i++)
        xy[6 + i] = (float)tiff_real_at(t, page, TIFF_WHITE, i);
    if (primaries_to_srgb(xy, m)) picture_light_set_primaries(xy, light);
}

status picture_tiff_light(const tiff_head *t, uint64_t page, const char *path, picture_light *out)
{
    exif_colours colours = exif_colours_of(t, tiff_value(t, page, TIFF_EXIF));
    *out = (picture_light){.said = colours == EXIF_COLOURS_SRGB};
    if (colours == EXIF_COLOURS_ADOBE) *out = picture_light_of_adobe_rgb();
    if (out->said) return OK;
    find_primaries(t, page, out);
    return find_curve(t, page, path, out);
}
