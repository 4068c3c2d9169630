/* SPDX-License-Identifier: MIT */
#include "photo_stereo/near_capture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "optics/brdf.h"
#include "optics/light.h"

status near_capture_new(const img *mask, const img *depth, float field_of_view, merlin_capture *out)
{
    int side = mask->width;
    *out = (merlin_capture){.width = side,
                            .height = mask->height,
                            .channels = 3,
                            .lighting = MERLIN_NEAR_LIGHTS,
                            .intensities_known = true,
                            .camera = pinhole_of(side, mask->height, field_of_view)};
    out->camera.distance = (float)img_mean_within(depth, mask);
    status s = img_copy(&out->mask, mask);
    for (size_t i = 0, n = (size_t)side * (size_t)mask->height; s == OK && i < n; i++)
        out->mask.data[i] = mask->data[i] > 0.5f;
    return s;
}

status near_capture_add(merlin_capture *c, const img *picture, const merlin_light *light)
{
    merlin_light with = *light;
    for (int k = 0; k < 3; k++)
        with.intensity[k] = (float)LIGHT_POWER / (NEAR_CAPTURE_WHITE * (float)PI);
    return pst_capture_add(c, picture, &with);
}
