/* Relighting by an environment against the path tracer, on an object that cannot shade itself. */
#include <math.h>
#include <string.h>

#include "estimate/relight_env.h"
#include "render/render.h"

/* cmocka names a macro fail, so that it comes behind base/status.h */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../render/shapes.h"

enum { SIZE = 48 };

static void render(const environment *env, sample *out)
{
    scn_object sphere = shape_sphere(vec3_make(0, 0, -1), 0.4f, 64);
    trace_device *device;
    trace_scene scene;
    image_settings settings = {.size = SIZE, .fov = 60, .strata = 2, .paths = 400};
    assert_int_equal(trace_device_new(&device), OK);
    assert_int_equal(trace_scene_new(device, &sphere, shape_patterned, 1e6, &scene), OK);
    assert_int_equal(render_image(&scene, &settings, 5, 1, env, out), OK);
    trace_scene_free(&scene);
    trace_device_free(device);
    shape_free(&sphere);
}

static void relit_sphere_agrees_with_the_path_tracer(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 3; seed++) {
        rng r = rng_at(seed, 0, 0);
        environment env;
        env_map map;
        sample truth;
        img image = {0};
        assert_int_equal(environment_procedural(&r, &env), OK);
        render(&env, &truth);
        assert_int_equal(env_map_new(&env.map, &map), OK);
        surface s = {truth.albedo, truth.normal, truth.roughness, truth.depth, truth.mask};
        assert_int_equal(img_new(&image, SIZE, SIZE, 3), OK);
        surface_add_ambient(&s, (const float(*)[3])map.sh, &image);
        surface_add_reflections(&s, &map, &image);
        double square = 0, mean = 0, bias = 0;
        int count = 0;
        for (int i = 0; i < SIZE * SIZE; i++) {
            if (truth.mask.data[i] < 0.999f) continue;
            for (int c = 3 * i; c < 3 * i + 3; c++, count++) {
                double e = (double)(image.data[c] - truth.env.data[c]);
                square += e * e;
                bias += e;
                mean += (double)truth.env.data[c];
            }
        }
        print_message("environment %d: mean %.3f, bias %.4f, root mean square error %.4f\n", (int)seed, mean / count,
                      bias / count, sqrt(square / count));
        /* three bands hold a lamp's irradiance to 9 % of its peak at worst, to 3 % in the mean over directions; the
         * tracer's noise with 400 paths is 2 % */
        assert_true(sqrt(square / count) < 0.08 * mean / count);
        assert_true(fabs(bias / count) < 0.02 * mean / count);
        sample_free(&truth);
        env_map_free(&map);
        environment_free(&env);
        img_free(&image);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(relit_sphere_agrees_with_the_path_tracer),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
