/* SPDX-License-Identifier: MIT */
#include "image/read/read.h"

enum { LEAST_HEIGHT = 4 };
/* Accepted ratios of width to height: some stitching programs leave a row or column too many. */
static const float LEAST_RATIO = 1.9f, MOST_RATIO = 2.1f;

static status check(const char *path, const img *map)
{
    if (map->width < 2 * LEAST_HEIGHT || map->height < LEAST_HEIGHT)
        return fail(MERLIN_BAD_INPUT, "%s is %d×%d pixels; an environment needs %d×%d at least", path, map->width,
                    map->height, 2 * LEAST_HEIGHT, LEAST_HEIGHT);
    float ratio = (float)map->width / (float)map->height;
    if (ratio < LEAST_RATIO || ratio > MOST_RATIO)
        return fail(MERLIN_BAD_INPUT,
                    "%s is %d×%d pixels; a latitude-longitude picture is twice as wide as high (a mirror ball's and a "
                    "cube's are other kinds; one that lacks sky and ground can be padded)",
                    path, map->width, map->height);
    return OK;
}

status img_read_latlong(const char *path, img *color)
{
    status s = img_read(path, color, NULL);
    if (s == OK) s = check(path, color);
    if (s != OK) img_free(color);
    return s;
}
