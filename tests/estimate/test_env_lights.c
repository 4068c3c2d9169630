/* SPDX-License-Identifier: MIT */
/* Distant lights must send what the surroundings send that they stand for. */
#include <math.h>

#include "estimate/light/env_lights.h"
#include "optics/octahedron.h"
#include "optics/sh.h"
#include "surroundings.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static const vec3 lamp = {0.48f, 0.6f, 0.64f};

static vec3 room_with_a_lamp(vec3 d)
{
    float wall = 0.4f + 0.2f * d.y;
    return vec3_dot(d, lamp) > 0.995f ? vec3_make(60, 50, 40) : vec3_make(wall, wall, 0.3f + 0.1f * d.x);
}

static void all_light_is_in_the_lights(void **state)
{
    (void)state;
    env_map e;
    env_light lights[ENV_LIGHTS_MOST];
    assert_int_equal(surroundings(room_with_a_lamp, 256, &e), OK);
    int count = env_lights(&e, lights), bright = 0;
    vec3 sum = {0, 0, 0};
    float angle = 0;
    for (int i = 0; i < count; i++) {
        sum = vec3_add(sum, lights[i].power);
        angle += lights[i].solid_angle;
        bright += vec3_dot(lights[i].direction, lamp) > 0.99f;
        assert_true(fabsf(vec3_length(lights[i].direction) - 1) < 1e-4f);
    }
    assert_true(fabsf(angle - 4 * PI) < 1e-3f);
    float per_sh = sqrtf(4 * PI); /* band 0 of radiance 1 from everywhere, times this, is 4π */
    assert_true(fabsf(sum.x / (e.sh[0][0] * per_sh) - 1) < 0.02f); /* texels against cells of the octahedron */
    assert_true(fabsf(sum.z / (e.sh[0][2] * per_sh) - 1) < 0.02f);
    assert_true(bright >= 8); /* the lamp is worth as much as the room but has 1/400 of the sphere */
    env_map_free(&e);
}

static vec3 sunset(vec3 d)
{
    return vec3_make(1 + 0.5f * d.x, 0.8f + 0.3f * d.y, 0.6f + 0.3f * d.z);
}

static void lights_of_a_smooth_sky_shine_as_it_does_and_turn_with_it(void **state)
{
    (void)state;
    env_map e;
    assert_int_equal(surroundings(sunset, 128, &e), OK);
    for (int turn = 0; turn < 3; turn++, env_map_turn(&e, 100)) {
        env_light lights[ENV_LIGHTS_MOST];
        int count = env_lights(&e, lights);
        for (int k = 0; k < 16; k++) {
            vec3 n = octahedron_direction(((float)(k % 4) + 0.5f) / 4, ((float)(k / 4) + 0.5f) / 4), sum = {0, 0, 0};
            for (int i = 0; i < count; i++)
                sum = vec3_fma(sum, fmaxf(vec3_dot(n, lights[i].direction), 0), lights[i].power);
            vec3 exact = sh_irradiance((const float(*)[3])e.sh, n);
            /* 256 directions of 0.05 steradians each, evenly spread: a few of 128 on the horizon count or do not */
            assert_true(fabsf(sum.x / exact.x - 1) < 0.02f);
            assert_true(fabsf(sum.y / exact.y - 1) < 0.02f);
            assert_true(fabsf(sum.z / exact.z - 1) < 0.02f);
        }
    }
    env_map_free(&e);
}

static vec3 night(vec3 d)
{
    (void)d;
    return vec3_make(0, 0, 0);
}

static void darkness_has_no_power(void **state)
{
    (void)state;
    env_map e;
    env_light lights[ENV_LIGHTS_MOST];
    assert_int_equal(surroundings(night, 64, &e), OK);
    int count = env_lights(&e, lights);
    for (int i = 0; i < count; i++) {
        assert_true(lights[i].power.x == 0 && lights[i].power.y == 0 && lights[i].power.z == 0);
        assert_true(isfinite(lights[i].direction.x));
    }
    env_map_free(&e);
}

static void octahedron_places_and_directions_are_inverse(void **state)
{
    (void)state;
    for (int k = 0; k < 400; k++) {
        float x = ((float)(k % 20) + 0.37f) / 20, y = ((float)(k / 20) + 0.61f) / 20, u, v;
        vec3 d = octahedron_direction(x, y);
        octahedron_place(d, &u, &v);
        assert_true(fabsf(vec3_length(d) - 1) < 1e-5f);
        assert_true(fabsf(u - x) < 1e-3f &&
                    fabsf(v - y) < 1e-3f); /* 1 - |z| keeps half of float's digits near a pole */
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_light_is_in_the_lights),
        cmocka_unit_test(lights_of_a_smooth_sky_shine_as_it_does_and_turn_with_it),
        cmocka_unit_test(darkness_has_no_power),
        cmocka_unit_test(octahedron_places_and_directions_are_inverse),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
