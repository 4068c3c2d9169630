/* SPDX-License-Identifier: MIT */
/* Environment maps: sampling, coefficients, and illumination. */
#include "lab/render/render.h"
#include "optics/latlong.h"
#include "optics/sh.h"
#include "shapes.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static environment uniform_environment(uint64_t seed)
{
    img map;
    environment env;
    rng r = rng_at(seed, 0, 0);
    assert_int_equal(img_new(&map, 32, 16, 3), OK);
    for (int i = 0; i < 32 * 16 * 3; i++)
        map.data[i] = 1;
    assert_int_equal(environment_from_map(&map, &r, &env), OK);
    img_free(&map);
    return env;
}

static void uniform_surroundings_light_a_convex_diffuse_object_by_its_albedo(void **state)
{
    (void)state;
    environment env = uniform_environment(1);
    float radiance = env.map.data[0];
    trace_device *device;
    trace_scene scene;
    sample out;
    scene_object sphere = shape_sphere(vec3_make(0, 0, -1), 0.35f, 64);
    assert_int_equal(trace_device_new(&device), OK);
    assert_int_equal(trace_scene_new(device, &sphere, shape_grey, 1e6, &scene), OK);
    scene.diffuse_only = true;
    image_settings settings = {.size = 32, .fov = 60, .strata = 4, .paths = 64};
    assert_int_equal(render_image(&scene, &settings, 1, 0, &env, &out), OK);
    double sum = 0, covered = 0;
    for (int i = 0; i < 32 * 32; i++) {
        sum += out.env.data[3 * i];
        covered += out.mask.data[i];
    }
    /* 25000 paths of relative deviation below 1: 0.6 %, three times that */
    assert_true(fabs(sum / covered - 0.5 * radiance) < 0.02 * 0.5 * radiance);
    /* ∫ L Y00 = L 2√π */
    assert_true(fabsf(out.sh[0][1] - radiance * 3.5449077f) < 1e-3f * radiance && fabsf(out.sh[2][1]) < 1e-3f);
    sample_free(&out);
    trace_scene_free(&scene);
    trace_device_free(device);
    shape_free(&sphere);
    environment_free(&env);
}

static environment_rays draw_one(const environment *env, rng *r)
{
    float u1[LANES] = {rng_uniform(r)}, u2[LANES] = {rng_uniform(r)};
    environment_rays drawn;
    environment_sample(env, u1, u2, 1, &drawn);
    return drawn;
}

static void sampling_a_map_integrates_what_looking_it_up_does(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 6; seed++) {
        rng r = rng_at(seed, 0, 0);
        environment env;
        assert_int_equal(environment_procedural(&r, &env), OK);
        double sampled = 0, looked_up = 0;
        enum { SAMPLES = 200000, ROWS = 512 };
        for (int i = 0; i < SAMPLES; i++) {
            environment_rays drawn = draw_one(&env, &r);
            sampled += drawn.radiance.y[0] / drawn.pdf[0];
            assert_true(fabsf(vec3_length(lanes_at(&drawn.direction, 0)) - 1) < 1e-4f);
        }
        for (int y = 0; y < ROWS; y++)
            for (int x = 0; x < 2 * ROWS; x++) {
                float v = ((float)y + 0.5f) / ROWS, u = ((float)x + 0.5f) / (2 * ROWS);
                real pdf;
                looked_up += environment_look(&env, latlong_direction(u, v), &pdf).y * sinf(3.14159265f * v);
            }
        sampled /= SAMPLES;
        looked_up *= 3.14159265 * 3.14159265 / ((double)ROWS * ROWS);
        /* the ratio of brightness and density varies by less than its mean where the light is: 3/sqrt(200000) */
        assert_true(fabs(sampled / looked_up - 1) < 0.01);
        /* band 0 is the total; interpolation at the poles and around a small sun costs a little */
        assert_true(fabs(env.sh[0][1] / 0.28209479 / looked_up - 1) < 0.01);
        environment_free(&env);
    }
}

static void density_at_a_drawn_direction_is_the_one_it_was_drawn_with(void **state)
{
    (void)state;
    rng r = rng_at(11, 0, 0);
    environment env;
    assert_int_equal(environment_procedural(&r, &env), OK);
    int equal = 0;
    for (int i = 0; i < 2000; i++) {
        environment_rays drawn = draw_one(&env, &r);
        vec3 d = lanes_at(&drawn.direction, 0);
        real pdf;
        environment_look(&env, d, &pdf);
        equal += fabsf(pdf - drawn.pdf[0]) <= 1e-3f * drawn.pdf[0];
    }
    /* directions on a texel's edge may round to its neighbour */
    assert_true(equal > 1980);
    environment_free(&env);
}

/* The sun is one texel in a dim sky, as in photographs of the sky. */
static void every_draw_from_a_small_sun_brings_about_the_same(void **state)
{
    (void)state;
    enum { DRAWS = 20000, WIDTH = 64, HEIGHT = 32 };
    rng r = rng_at(5, 0, 0);
    for (int y = 1; y < HEIGHT - 1; y += 5) {
        img map;
        environment env;
        assert_int_equal(img_new(&map, WIDTH, HEIGHT, 3), OK);
        for (int i = 0; i < WIDTH * HEIGHT * 3; i++)
            map.data[i] = 0.1f;
        for (int c = 0; c < 3; c++)
            img_at(&map, 20, y)[c] = 5000;
        assert_int_equal(environment_from_map(&map, &r, &env), OK);
        double all = env.sh[0][1] / 0.28209479, sum = 0;
        for (int i = 0; i < DRAWS; i++) {
            environment_rays drawn = draw_one(&env, &r);
            double brought = drawn.radiance.y[0] / drawn.pdf[0];
            real pdf;
            environment_look(&env, lanes_at(&drawn.direction, 0), &pdf);
            assert_true(fabsf(pdf - drawn.pdf[0]) < 1e-2f * pdf);
            assert_true(brought < 2 * all); /* 1.7 near the poles, where rows differ in solid angle */
            sum += brought;
        }
        /* one sample in twenty is uniform over the sphere and adds next to nothing: 0.2 / sqrt(20000), six times that
         */
        assert_true(fabs(sum / DRAWS / all - 1) < 0.01);
        img_free(&map);
        environment_free(&env);
    }
}

static void middle_of_the_map_is_straight_ahead_and_its_top_is_up(void **state)
{
    (void)state;
    vec3 ahead = latlong_direction(0.5f, 0.5f), up = latlong_direction(0.3f, 0), right = latlong_direction(0.75f, 0.5f);
    assert_true(ahead.z < -0.9999f && up.y > 0.9999f && right.x > 0.9999f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(uniform_surroundings_light_a_convex_diffuse_object_by_its_albedo),
        cmocka_unit_test(sampling_a_map_integrates_what_looking_it_up_does),
        cmocka_unit_test(density_at_a_drawn_direction_is_the_one_it_was_drawn_with),
        cmocka_unit_test(every_draw_from_a_small_sun_brings_about_the_same),
        cmocka_unit_test(middle_of_the_map_is_straight_ahead_and_its_top_is_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
