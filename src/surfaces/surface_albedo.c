/* SPDX-License-Identifier: MIT */
#include "surfaces/surface_albedo.h"

#include "stereo/fit/albedo_scale.h"

status surface_albedo(const merlin_surface *s, img *out)
{
    float scale;
    status result = img_new(out, s->albedo.width, s->albedo.height, 3);
    if (result != OK) return result;
    const size_t channels = (size_t)s->albedo.channels;
    for (size_t i = 0, values = img_value_count(out); i < values; i++)
        out->data[i] = s->albedo.data[i / 3 * channels + (channels == 3 ? i % 3 : 0)];
    result = pst_scale_albedo(out, &s->mask, &scale);
    if (result != OK) img_free(out);
    return result;
}
