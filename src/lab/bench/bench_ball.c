/* SPDX-License-Identifier: MIT */
#include "lab/bench/bench_ball.h"

#include <math.h>
#include <string.h>

#include "lab/eval/samples/truth.h"

enum { PICTURE = 256 };

/* Draws the maps of a ball of radius 0.4 about (0, 0, -1.2), with rings of two colours. */
static void draw_ball(surface *maps)
{
    camera view = {.width = PICTURE, .height = PICTURE, .fov = CAMERA_FOV};
    vec3 centre = {0, 0, -1.2f};
    for (int y = 0; y < PICTURE; y++) {
        for (int x = 0; x < PICTURE; x++) {
            vec3 d = camera_ray(&view, (float)x + 0.5f, (float)y + 0.5f);
            float along = vec3_dot(d, centre), inside = along * along - vec3_dot(centre, centre) + 0.4f * 0.4f;
            if (inside <= 0) continue;
            vec3 p = vec3_scale(d, along - sqrtf(inside)), n = vec3_scale(vec3_sub(p, centre), 1 / 0.4f);
            float ring = sinf(20 * p.y) > 0 ? 0.8f : 0.3f;
            memcpy(img_at(&maps->albedo, x, y), (float[3]){ring, 0.6f, 1 - ring}, 3 * sizeof(float));
            memcpy(img_at(&maps->normal, x, y), (float[3]){n.x, n.y, n.z}, 3 * sizeof(float));
            *img_at(&maps->roughness, x, y) = 0.4f;
            *img_at(&maps->depth, x, y) = -p.z;
            *img_at(&maps->mask, x, y) = 1;
        }
    }
}

status bench_ball(img *picture)
{
    surface maps;
    *picture = (img){0};
    status s = surface_new(PICTURE, PICTURE, &maps);
    if (s != OK) return s;
    draw_ball(&maps);
    s = eval_render(&maps, &(illumination){{0, 0, 0}, NULL}, 1, picture);
    surface_free(&maps);
    return s;
}
