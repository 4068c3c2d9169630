/* SPDX-License-Identifier: MIT */
/* Shading and its hand-written derivative, in double so that finite differences are precise; and camera and target
 * lights. */
#define MERLIN_REAL double
#include "optics/light.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/rng.h"
#include "optics/camera.h"

static double uniform(rng *r, double low, double high)
{
    return low + (high - low) * rng_uniform(r);
}

/* Returns a pixel whose cosines are away from their clamps, so that the function is smooth around it. */
static shade_input random_pixel(rng *r, bool flash)
{
    for (;;) {
        shade_input in = {.albedo = {uniform(r, 0, 1), uniform(r, 0, 1), uniform(r, 0, 1)},
                          .roughness = uniform(r, 0.1, 0.98),
                          .normal =
                              vec3_normalize(vec3_make(uniform(r, -1, 1), uniform(r, -1, 1), uniform(r, 0.05, 1))),
                          .depth = uniform(r, 0.6, 1.5),
                          .ray = {uniform(r, -0.5, 0.5), uniform(r, -0.5, 0.5), -1},
                          .light = {0, 0, 0},
                          .power = 5.95};
        if (!flash) in.light = frontal_light(rng_uniform(r), rng_uniform(r));
        shade_terms t = shade_terms_of(&in);
        if (t.n_l > 0.02 && t.n_v > 0.02 && t.n_h < 0.9999 && t.distance > 0.05) return in;
    }
}

static double *parameter(shade_input *in, int i)
{
    double *all[] = {&in->albedo.x, &in->albedo.y, &in->albedo.z, &in->roughness,
                     &in->normal.x, &in->normal.y, &in->normal.z, &in->depth};
    return all[i];
}

static void check_gradient(shade_input in, vec3 weight)
{
    shade_gradient g = shade_point_gradient(&in, weight);
    double analytic[8] = {g.albedo.x, g.albedo.y, g.albedo.z, g.roughness, g.normal.x, g.normal.y, g.normal.z, g.depth};
    double largest = 0;
    for (int i = 0; i < 8; i++)
        largest = fmax(largest, fabs(analytic[i]));
    for (int i = 0; i < 8; i++) {
        double step = 1e-5, value = *parameter(&in, i), difference[2];
        for (int half = 0; half < 2; half++) {
            double s = half ? step / 2 : step;
            *parameter(&in, i) = value + s;
            double high = vec3_dot(weight, shade_point(&in));
            *parameter(&in, i) = value - s;
            difference[half] = (high - vec3_dot(weight, shade_point(&in))) / (2 * s);
        }
        *parameter(&in, i) = value;
        /* Richardson: the second-order error of the differences cancels. What remains is rounding, 1e-16 / 1e-5 of the
         * value, and the polynomial 2^x against its true slope: 1e-6 of the largest derivative. */
        double expected = (4 * difference[1] - difference[0]) / 3;
        if (!(fabs(analytic[i] - expected) <= 1e-6 * fmax(largest, 1)))
            fail_msg("derivative %d is %.12g, differences say %.12g", i, analytic[i], expected);
    }
}

static void shading_gradient_matches_finite_differences(void **state)
{
    (void)state;
    rng r = rng_at(3, 0, 0);
    for (int i = 0; i < 4000; i++) {
        vec3 weight = {uniform(&r, -1, 1), uniform(&r, -1, 1), uniform(&r, -1, 1)};
        check_gradient(random_pixel(&r, i % 2 == 0), weight);
    }
}

static void shading_is_the_formula_of_the_conventions(void **state)
{
    (void)state;
    rng r = rng_at(4, 0, 0);
    for (int i = 0; i < 1000; i++) {
        shade_input in = random_pixel(&r, i % 2 == 0);
        vec3 p = vec3_scale(in.ray, in.depth), d = vec3_sub(in.light, p);
        vec3 l = vec3_normalize(d), v = vec3_normalize(vec3_scale(p, -1));
        double expected =
            5.95 * brdf_eval(in.albedo, in.roughness, in.normal, l, v).y * vec3_dot(in.normal, l) / vec3_dot(d, d);
        assert_true(fabs(shade_point(&in).y - expected) <= 1e-12 * expected);
    }
}

static void surface_facing_away_from_the_light_is_black(void **state)
{
    (void)state;
    shade_input in = {{1, 1, 1}, 0.5, {0, 0, 1}, 1, {0.1, 0.2, -1}, {0, 0, -2}, 5.95};
    vec3 radiance = shade_point(&in);
    assert_true(radiance.x == 0 && radiance.y == 0 && radiance.z == 0);
}

static void shading_is_finite_for_empty_pixels_and_degenerate_lights(void **state)
{
    (void)state;
    static const double depths[] = {0, 1e-9, 1, 1e6}, roughness[] = {0, 0.03, 1, 5};
    static const vec3 normals[] = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 0, -1}, {10, 10, 10}};
    static const vec3 lights[] = {{0, 0, 0}, {0, 0, -1}, {0, 0, -2}, {1, 0, -1}};
    for (int d = 0; d < 4; d++)
        for (int r = 0; r < 4; r++)
            for (int n = 0; n < 5; n++)
                for (int l = 0; l < 4; l++) {
                    shade_input in = {{0, 0.5, 1}, roughness[r], normals[n], depths[d], {0, 0, -1}, lights[l], 5.95};
                    shade_gradient g = shade_point_gradient(&in, vec3_make(1, -1, 2));
                    assert_true(isfinite(vec3_length(shade_point(&in))));
                    assert_true(isfinite(vec3_length(g.albedo)) && isfinite(vec3_length(g.normal)));
                    assert_true(isfinite(g.roughness) && isfinite(g.depth));
                }
}

static void projecting_a_camera_point_returns_its_pixel(void **state)
{
    (void)state;
    camera c = {.width = 200, .height = 100, .fov = 60};
    rng r = rng_at(5, 0, 0);
    for (int i = 0; i < 100; i++) {
        double x = uniform(&r, 0, 200), y = uniform(&r, 0, 100), depth = uniform(&r, 0.1, 5), u, v;
        vec3 p = camera_point(&c, x, y, depth);
        assert_true(fabs(-p.z - depth) < 1e-12);
        camera_project(&c, p, &u, &v);
        assert_true(fabs(u - x) < 1e-9 && fabs(v - y) < 1e-9);
    }
}

static void a_slanted_cameras_points_return_to_their_pixels(void **state)
{
    (void)state;
    rng r = rng_at(8, 0, 0);
    for (int i = 0; i < 100; i++) {
        camera c = {.width = 200, .height = 100, .fov = uniform(&r, 5, 75)};
        c.slant = camera_tilt(uniform(&r, -35, 35), uniform(&r, -35, 35));
        double x = uniform(&r, 0, 200), y = uniform(&r, 0, 100), depth = uniform(&r, 0.1, 5), u, v;
        vec3 p = camera_point(&c, x, y, depth);
        assert_true(fabs(-p.z - depth) < 1e-12);
        camera_project(&c, p, &u, &v);
        assert_true(fabs(u - x) < 1e-9 && fabs(v - y) < 1e-9);
    }
}

/* Angles do not depend on the crop: the lines of sight of two pixels of a crop enclose the same angle as those of the
 * same points in the whole picture. */
static void a_cut_sees_along_the_same_lines_as_the_whole_picture(void **state)
{
    (void)state;
    const double right = 20, up = -10;
    camera whole = {.width = 1000, .height = 1000, .fov = 80}, cut = {.width = 100, .height = 100};
    cut.slant = camera_tilt(right, up);
    double unit = camera_pixel_size(&whole), x = 500 + tan(right * DEGREE) / unit, y = 500 - tan(up * DEGREE) / unit,
           forward = sqrt(1 - cut.slant.right * cut.slant.right - cut.slant.up * cut.slant.up);
    cut.fov = 2 * atan(50 * unit * forward) / DEGREE;
    for (int i = -50; i <= 50; i += 25)
        for (int j = -50; j <= 50; j += 20) {
            double as_cut = vec3_dot(camera_ray(&cut, 50 + i, 50 + j), camera_ray(&cut, 20, 70));
            double as_whole = vec3_dot(camera_ray(&whole, x + i, y + j), camera_ray(&whole, x - 30, y + 20));
            assert_true(fabs(as_cut - as_whole) < 1e-12);
        }
    vec3 middle = camera_ray(&cut, 50, 50);
    assert_true(fabs(middle.x) < 1e-12 && fabs(middle.y) < 1e-12 && middle.z < 0);
}

static void camera_sees_its_field_of_view(void **state)
{
    (void)state;
    camera c = {.width = 64, .height = 64, .fov = 60};
    vec3 right = camera_ray(&c, 64, 32), top = camera_ray(&c, 32, 0);
    assert_true(fabs(atan2(right.x, -right.z) - 3.14159265358979 / 6) < 1e-12 && right.y == 0);
    assert_true(top.y > 0 && top.x == 0);
}

static void target_lights_lie_on_the_frontal_hemisphere(void **state)
{
    (void)state;
    rng r = rng_at(6, 0, 0);
    for (int i = 0; i < 1000; i++) {
        vec3 light = frontal_light(rng_uniform(&r), rng_uniform(&r));
        vec3 from_object = vec3_sub(light, vec3_make(0, 0, -1));
        assert_true(fabs(vec3_length(from_object) - 1) < 1e-9 && light.z >= -1);
    }
    vec3 flash = frontal_light(1, 0.3);
    assert_true(vec3_length(flash) < 1e-7);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shading_gradient_matches_finite_differences),
        cmocka_unit_test(shading_is_the_formula_of_the_conventions),
        cmocka_unit_test(surface_facing_away_from_the_light_is_black),
        cmocka_unit_test(shading_is_finite_for_empty_pixels_and_degenerate_lights),
        cmocka_unit_test(projecting_a_camera_point_returns_its_pixel),
        cmocka_unit_test(a_slanted_cameras_points_return_to_their_pixels),
        cmocka_unit_test(a_cut_sees_along_the_same_lines_as_the_whole_picture),
        cmocka_unit_test(camera_sees_its_field_of_view),
        cmocka_unit_test(target_lights_lie_on_the_frontal_hemisphere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
