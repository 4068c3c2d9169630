/* SPDX-License-Identifier: MIT */
#include "estimate/surface/sight.h"

#include <math.h>

#include "estimate/surface/surface.h"
#include "optics/pinhole.h"

/* Limits of a crop's field of view in degrees. Others come from wrong numbers in EXIF; where somebody says so, the
 * nearest one is taken. */
static const float NARROWEST = 1, WIDEST = 130;

/* Returns the distance of the image plane in pixels; 0: unknown. */
static double focal_pixels(float fov, float focal_35mm, int width, int height)
{
    if (fov > 0) return width / (2 * (double)camera_tangent(fov));
    return (double)pinhole_focal_of_35mm(width, height, focal_35mm);
}

sight sight_of(float fov, float focal_35mm, int width, int height, crop_square crop)
{
    const double focal = focal_pixels(fov, focal_35mm, width, height);
    sight how = {.flash = false};
    if (!(focal > 0)) return how;
    double right = (crop.x + crop.side / 2.0 - width / 2.0) / focal,
           up = (height / 2.0 - crop.y - crop.side / 2.0) / focal;
    double far = sqrt(1 + right * right + up * up); /* distance of the crop's middle, where the plane's is 1 */
    float wide = (float)(2 * atan(crop.side / (2 * focal * far)) / (double)DEGREE);
    if (fov > 0) wide = fminf(fmaxf(wide, NARROWEST), WIDEST);
    if (!(wide >= NARROWEST && wide <= WIDEST)) return how;
    how.lens = (camera_lens){wide, {(float)(right / far), (float)(up / far)}};
    return how;
}

/* Returns v rotated by the least rotation that takes unit a to unit b. */
static vec3 turn(vec3 v, vec3 a, vec3 b)
{
    vec3 sum = vec3_add(a, b);
    float along = vec3_dot(v, sum) / (1 + vec3_dot(a, b));
    return vec3_fma(vec3_fma(v, -along, sum), 2 * vec3_dot(v, a), b);
}

void sight_turn_normals(camera_lens lens, const img *mask, img *normal)
{
    if (!(lens.fov > 0)) return;
    const camera_lens usual = {.fov = CAMERA_FOV};
    const camera taken = camera_through(usual, mask->width, mask->height),
                 meant = camera_through(lens, mask->width, mask->height);
    for (int y = 0; y < mask->height; y++) {
        const img_span span = img_row_span(mask, y);
        for (int x = span.first; x < span.end; x++) {
            float *n = img_at(normal, x, y), column = (float)x + 0.5f, row = (float)y + 0.5f;
            vec3_put(turn(vec3_of(n), camera_ray(&taken, column, row), camera_ray(&meant, column, row)), n);
        }
    }
}

void sight_take_relief(camera_lens lens, const img *mask, img *depth)
{
    if (!(lens.fov > 0)) return;
    const float scale = camera_tangent(lens.fov) / camera_tangent(CAMERA_FOV);
    for (size_t i = 0; i < img_value_count(depth); i++)
        if (mask->data[i] > 0) depth->data[i] = 1 + (depth->data[i] - 1) * scale;
}
