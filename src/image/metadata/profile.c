/* SPDX-License-Identifier: MIT */
#include "image/metadata/profile.h"

#include "image/metadata/icc.h"

/* Returns the number of bands without alpha. */
static int colours_of(VipsImage *image)
{
    int bands = vips()->image_get_bands(image);
    return vips()->image_hasalpha(image) && bands > 1 ? bands - 1 : bands;
}

static int channels_of(VipsImage *image)
{
    const void *data = NULL;
    size_t size = 0;
    if (!vips()->image_get_typeof(image, VIPS_META_ICC_NAME)) return 0;
    return vips()->image_get_blob(image, VIPS_META_ICC_NAME, &data, &size) ? 0 : icc_channels(data, size);
}

bool profile_is_fit(VipsImage *image)
{
    int channels = channels_of(image), colours = colours_of(image);
    return channels > 0 && (channels == colours || (channels == 3 && colours == 1));
}

/* Converts grey to three equal colours. */
static bool make_colours(VipsImage **image)
{
    VipsImage *two = NULL, *three = NULL;
    if (vips()->bandjoin2(*image, *image, &two, NULL)) return false;
    bool made = vips_pass_on(image, &three, vips()->bandjoin2(two, *image, &three, NULL));
    vips()->g_object_unref(two);
    return made &&
           vips_pass_on(image, &two, vips()->copy(*image, &two, "interpretation", VIPS_INTERPRETATION_sRGB, NULL));
}

static bool transform(VipsImage *image, int colours, VipsImage **out)
{
    VipsImage *made = NULL;
    *out = NULL;
    if (vips()->extract_band(image, out, 0, "n", colours, NULL)) return false;
    bool good = channels_of(image) == colours || make_colours(out);
    if (good)
        good = vips_pass_on(out, &made,
                            vips()->icc_transform(*out, &made, "srgb", "embedded", TRUE, "depth", 16, "intent",
                                                  VIPS_INTENT_RELATIVE, NULL));
    if (!good) vips()->g_object_unref(*out);
    return good;
}

/* Appends the picture's alpha to the colours, scaled to 16 bits. */
static bool add_alpha(VipsImage *image, int band, VipsImage **out)
{
    VipsImage *alpha = NULL, *made = NULL;
    double most = vips()->image_get_format(image) == VIPS_FORMAT_UCHAR ? 255 : 65535;
    if (vips()->extract_band(image, &alpha, band, NULL)) return false;
    bool good = vips_pass_on(&alpha, &made, vips()->linear1(alpha, &made, 65535 / most, 0.0, NULL)) &&
                vips_pass_on(&alpha, &made, vips()->cast(alpha, &made, VIPS_FORMAT_USHORT, NULL)) &&
                vips_pass_on(out, &made, vips()->bandjoin2(*out, alpha, &made, NULL));
    vips()->g_object_unref(alpha);
    return good;
}

bool profile_apply(VipsImage *image, VipsImage **out)
{
    int colours = colours_of(image);
    if (!transform(image, colours, out)) return false;
    if (colours == vips()->image_get_bands(image) || add_alpha(image, colours, out)) return true;
    vips()->g_object_unref(*out);
    return false;
}

status profile_light(VipsImage *image, const char *path, picture_light *out)
{
    const void *data = NULL;
    size_t size = 0;
    *out = (picture_light){.said = false};
    if (!profile_is_fit(image) || vips()->image_get_blob(image, VIPS_META_ICC_NAME, &data, &size)) return OK;
    if (icc_light(data, size, out)) return OK;
    return fail(MERLIN_BAD_INPUT,
                "cannot read %s: its floats have a colour profile that is no curve and three primaries; save it as "
                "linear sRGB",
                path);
}
