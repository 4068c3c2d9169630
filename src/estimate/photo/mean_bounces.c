/* SPDX-License-Identifier: MIT */
#include "estimate/photo/mean_bounces.h"

#include "estimate/light/relight_env.h"

status mean_bounces(network *n, const network_estimation *mean, img *indirect)
{
    const surface *maps = &mean->maps;
    const bool in_environment = network_config(n)->lighting == MODEL_LIGHT_BOTH;
    img direct = {0}, ambient = {0};
    *indirect = (img){0};
    status s = surface_shade(maps, vec3_make(0, 0, 0), &direct);
    if (s == OK && in_environment) s = img_new(&ambient, direct.width, direct.height, 3);
    if (s == OK && in_environment) surface_add_ambient(maps, (const float(*)[3])mean->environment, &ambient);
    if (s == OK) s = network_indirect(n, maps, &direct, in_environment ? &ambient : NULL, indirect);
    img_free(&direct);
    img_free(&ambient);
    return s;
}
