/* SPDX-License-Identifier: MIT */
/* Depth by many normals, integrated as they are and by blocks. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

#include "photo_stereo/refit_depth.h"

enum { SIDE = 180, WAVE = 9 };

/* A bowl with waves of WAVE pixels. */
static float depth_at(const camera *view, float x, float y)
{
    const vec3 ray = camera_ray(view, x, y);
    const float wave = 6.2831853f / WAVE;
    return 1 + 0.4f * (ray.x * ray.x + ray.y * ray.y) + 0.002f * sinf(wave * x) * sinf(wave * y);
}

static vec3 point_at(const camera *view, float x, float y)
{
    const vec3 ray = camera_ray(view, x, y);
    return vec3_scale(ray, depth_at(view, x, y) / -ray.z);
}

/* Makes the surface, with a depth that tells no more than how far it is. */
static void make(surface *out)
{
    *out = (surface){.lens = {.fov = 35}};
    assert_int_equal(img_new(&out->normal, SIDE, SIDE, 3), OK);
    assert_int_equal(img_new(&out->depth, SIDE, SIDE, 1), OK);
    assert_int_equal(img_new(&out->mask, SIDE, SIDE, 1), OK);
    const camera view = surface_camera(out);
    for (int j = 0; j < SIDE; j++)
        for (int i = 0; i < SIDE; i++) {
            const float x = (float)i + 0.5f, y = (float)j + 0.5f, from_middle = hypotf(x - SIDE / 2, y - SIDE / 2);
            if (from_middle > 0.48f * SIDE) continue;
            const vec3 across = vec3_sub(point_at(&view, x + 0.1f, y), point_at(&view, x - 0.1f, y));
            const vec3 down = vec3_sub(point_at(&view, x, y + 0.1f), point_at(&view, x, y - 0.1f));
            *img_at(&out->mask, i, j) = 1;
            *img_at(&out->depth, i, j) = 1.1f;
            vec3_put(vec3_normalize(vec3_cross(down, across)), img_at(&out->normal, i, j));
            assert_true(img_at(&out->normal, i, j)[2] > 0);
        }
}

/* Computes the standard deviation of the logarithm of depth over the true one. */
static double error_of(const surface *s)
{
    const camera view = surface_camera(s);
    double sum = 0, squares = 0, count = 0;
    for (int j = 0; j < SIDE; j++)
        for (int i = 0; i < SIDE; i++) {
            if (!(*img_at(&s->mask, i, j) > 0)) continue;
            const float depth = *img_at(&s->depth, i, j);
            assert_true(depth > 0.5f && depth < 2);
            const double ratio = log((double)(depth / depth_at(&view, (float)i + 0.5f, (float)j + 0.5f)));
            sum += ratio;
            squares += ratio * ratio;
            count++;
        }
    return sqrt(squares / count - sum / count * sum / count);
}

static double error_by(size_t most)
{
    surface s;
    make(&s);
    assert_int_equal(refit_surface_depth(&s, most), OK);
    const double error = error_of(&s);
    surface_free(&s);
    return error;
}

/* The waves alone, which blocks of 5 × 5 do not show, deviate by 1e-3. */
static void blocks_are_nearly_as_exact_as_pixels(void **state)
{
    (void)state;
    surface flat;
    make(&flat);
    assert_true(error_of(&flat) > 5e-3);
    surface_free(&flat);
    assert_true(error_by(REFIT_INTEGRATED) < 1e-4);
    for (size_t most = 12000; most > 1000; most /= 3) /* blocks of 2 × 2, 3 × 3 and 5 × 5 */
        assert_true(error_by(most) < 5e-4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(blocks_are_nearly_as_exact_as_pixels)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
