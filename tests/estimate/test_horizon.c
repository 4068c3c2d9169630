/* SPDX-License-Identifier: MIT */
/* Surfaces whose view of the sky is known in closed form. */
#include <math.h>
#include <stdbool.h>

#include "estimate/light/relight_env.h"
#include "optics/octahedron.h"
#include "spheres.h"
#include "surroundings.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { SIDE = SPHERES_SIDE, PIXELS = SPHERES_PIXELS };

static void horizon_of(const surface *s, horizon *out)
{
    shadow_occluder occluder;
    assert_int_equal(shadow_occluder_new(&s->depth, &s->normal, &s->mask, (camera_lens){.fov = CAMERA_FOV}, &occluder),
                     OK);
    assert_int_equal(horizon_new(&occluder, out), OK);
    shadow_occluder_free(&occluder);
}

static vec3 white(vec3 d)
{
    (void)d;
    return vec3_make(1, 1, 1);
}

static float sees(const horizon *h, int i, vec3 direction)
{
    horizon_view at;
    horizon_at(h, ((float)(i % SIDE) + 0.5f) / SIDE, ((float)(i / SIDE) + 0.5f) / SIDE, &at);
    return horizon_sees(&at, direction, 0.01f);
}

static void a_ball_alone_sees_all_of_the_sky_that_it_faces(void **state)
{
    (void)state;
    surface s;
    horizon h;
    assert_int_equal(surface_new(SIDE, SIDE, &s), OK);
    spheres_put(&s, vec3_make(0, 0, -1), 0.35f, false, 0);
    horizon_of(&s, &h);
    for (int i = 0; i < PIXELS; i += 7) {
        if (s.mask.data[i] < 0.5f) continue;
        vec3 n = vec3_of(s.normal.data + 3 * i);
        /* in the outermost pixels the ball falls off by several from one to the next */
        if (vec3_dot(n, vec3_normalize(spheres_ray(i))) > -0.3f) continue;
        for (int k = 0; k < 64; k++) {
            vec3 d = octahedron_direction(((float)(k % 8) + 0.5f) / 8, ((float)(k / 8) + 0.5f) / 8);
            if (vec3_dot(n, d) > 0.2f) assert_true(sees(&h, i, d) > 0.99f);
        }
    }
    horizon_free(&h);
    surface_free(&s);
}

/* From inside a sphere every piece of it is seen under the same factor, its share of the sphere's area: of an even sky
 * all points of a bowl that is cut from a sphere get what the missing part would send. */
static void every_point_of_a_bowl_gets_the_same_share_of_an_even_sky(void **state)
{
    (void)state;
    const float deeper = 0.3f, bowl = (1 - deeper) / 2, albedo[] = {0, 0.8f};
    env_map e;
    assert_int_equal(surroundings(white, 64, &e), OK);
    for (int a = 0; a < 2; a++) {
        surface s;
        horizon h;
        img share;
        assert_int_equal(surface_new(SIDE, SIDE, &s), OK);
        spheres_put(&s, vec3_make(0, 0, -1.1f), 0.4f, true, deeper);
        for (int i = 0; i < 3 * PIXELS; i++)
            s.albedo.data[i] = s.mask.data[i / 3] * albedo[a];
        horizon_of(&s, &h);
        assert_int_equal(surface_arriving_light(&s, &h, &e, &share), OK);
        double sum = 0, square = 0, count = 0;
        for (int i = 0; i < PIXELS; i++) {
            if (s.mask.data[i] < 0.5f) continue;
            double x = (double)share.data[3 * i];
            sum += x;
            square += x * x;
            count++;
        }
        double mean = sum / count, expected = (double)((1 - bowl) * (1 + albedo[a] * bowl));
        print_message("albedo %.1f: %.3f of %.3f, spread %.3f\n", (double)albedo[a], mean, expected,
                      sqrt(fmax(square / count - mean * mean, 0)));
        /* a pixel of margin and half of one at the rim, seen under 0.01 radians each from the middle: 0.02 */
        assert_true(fabs(mean - expected) < 0.03);
        assert_true(square / count - mean * mean < 0.04 * 0.04);
        img_free(&share);
        horizon_free(&h);
        surface_free(&s);
    }
    env_map_free(&e);
}

/* A small ball far before a wall: the wall's sky has a hole where the ball is, and goes on behind it. */
static void light_passes_behind_what_stands_free(void **state)
{
    (void)state;
    const vec3 ball = {0.15f, 0, -0.8f}, point = {0, 0, -1.2f};
    surface s;
    horizon h;
    assert_int_equal(surface_new(SIDE, SIDE, &s), OK);
    for (int i = 0; i < PIXELS; i++)
        spheres_put_pixel(&s, i, -point.z, vec3_make(0, 0, 1));
    spheres_put(&s, ball, 0.06f, false, 0);
    horizon_of(&s, &h);
    const int middle = SIDE / 2 * SIDE + SIDE / 2;
    const vec3 before = {0.03f, 0, 0.7f}, behind = {0.32f, 0, 0.15f};
    assert_true(sees(&h, middle, vec3_normalize(before)) > 0.99f);
    assert_true(sees(&h, middle, vec3_normalize(vec3_sub(ball, point))) < 0.01f);
    assert_true(sees(&h, middle, vec3_normalize(behind)) > 0.9f);
    horizon_free(&h);
    surface_free(&s);
}

static void a_surface_of_no_pixels_hides_nothing(void **state)
{
    (void)state;
    surface s;
    horizon h;
    assert_int_equal(surface_new(SIDE, SIDE, &s), OK);
    horizon_of(&s, &h);
    for (int k = 0; k < 64; k++)
        assert_true(sees(&h, 0, octahedron_direction(((float)(k % 8) + 0.5f) / 8, ((float)(k / 8) + 0.5f) / 8)) >=
                    0.5f);
    horizon_free(&h);
    surface_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ball_alone_sees_all_of_the_sky_that_it_faces),
        cmocka_unit_test(every_point_of_a_bowl_gets_the_same_share_of_an_even_sky),
        cmocka_unit_test(light_passes_behind_what_stands_free),
        cmocka_unit_test(a_surface_of_no_pixels_hides_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
