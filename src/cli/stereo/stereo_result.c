/* SPDX-License-Identifier: MIT */
#include "cli/stereo/stereo_result.h"

void stereo_result_free(stereo_result *r)
{
    img *images[] = {&r->normal, &r->albedo, &r->depth, &r->mask, &r->error};
    for (size_t i = 0; i < sizeof images / sizeof images[0]; i++)
        img_free(images[i]);
    skipped_free(&r->skipped);
}
