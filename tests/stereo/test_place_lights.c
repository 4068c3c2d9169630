/* SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

#include "relief.h"
#include "sanitized.h"
#include "stereo/methods/place_lights.h"

enum { SIZE = 40, LIGHTS = 8 };
/* A ball about the middle of a dome, in millimetres, which the camera sees 30 degrees wide. */
static const float radius = 70, reach = 300, distance = 600, view = 30;

/* On two rings, 30 and 55 degrees from the camera's side. */
static vec3 about_ball(int k)
{
    float turn = 6.2831853f * (float)k / LIGHTS, slope = k % 2 ? 0.52f : 0.96f;
    return vec3_scale(vec3_make(sinf(slope) * cosf(turn), sinf(slope) * sinf(turn), cosf(slope)), reach);
}

/* Of a lamp beside the ball, or as far away as its direction says. */
static float shade(vec3 at, vec3 n, vec3 lamp, bool far)
{
    vec3 to = far ? lamp : vec3_sub(lamp, at);
    float squared = far ? reach * reach : vec3_dot(to, to);
    return fmaxf(vec3_dot(n, vec3_normalize(to)), 0) * reach * reach / squared;
}

static void ball_pixel(merlin_capture *c, int i, int j, bool far)
{
    vec3 ray = vec3_normalize(vec3_make(((float)i + 0.5f - c->camera.x) / c->camera.focal,
                                        (c->camera.y - (float)j - 0.5f) / c->camera.focal, -1));
    float along = -ray.z * distance, inside = along * along - distance * distance + radius * radius;
    if (inside < 0.12f * radius * radius) return; /* up to 70 degrees */
    vec3 at = vec3_add(vec3_scale(ray, along - sqrtf(inside)), vec3_make(0, 0, distance));
    vec3 n = vec3_scale(at, 1 / radius);
    size_t pixel = (size_t)j * SIZE + (size_t)i;
    c->mask.data[pixel] = 1;
    memcpy(c->normal_true.data + 3 * pixel, &(float[3]){n.x, n.y, n.z}, 3 * sizeof(float));
    for (int k = 0; k < LIGHTS; k++)
        c->picture[k].wide[pixel] = relief_code(0.4f * shade(at, n, about_ball(k), far));
}

/* As a list of places about the object is read, whose lights stand there or are far away. */
static void ball_capture(merlin_capture *c, bool far, bool asked, float unit)
{
    capture_new(c, SIZE, LIGHTS, 1);
    c->lighting = asked ? MERLIN_NEAR_LIGHTS : MERLIN_DISTANT_LIGHTS;
    c->camera = pinhole_of(SIZE, SIZE, view);
    c->about_object = true;
    c->name = calloc(LIGHTS, sizeof *c->name);
    for (int k = 0; k < LIGHTS; k++) {
        c->name[k] = strdup("lit.png");
        vec3_put(vec3_scale(about_ball(k), unit), c->light[k].position);
        vec3_put(vec3_normalize(about_ball(k)), c->light[k].direction);
    }
    for (int i = 0; i < SIZE * SIZE; i++)
        ball_pixel(c, i % SIZE, i / SIZE, far);
}

static double solved_angle(const merlin_capture *c, merlin_stereo_method method)
{
    merlin_surface s;
    assert_int_equal(pst_solve(c, &(merlin_stereo_params){.method = MERLIN_STEREO_AUTO}, &s), OK);
    assert_int_equal(s.method, method);
    double angle = mean_angle(c, &s.normal);
    merlin_surface_free(&s);
    return angle;
}

static void check_places(const merlin_capture *c, float tolerance)
{
    assert_int_equal(c->lighting, MERLIN_NEAR_LIGHTS);
    assert_false(c->about_object);
    for (int k = 0; k < LIGHTS; k++) {
        vec3 true_place = vec3_add(about_ball(k), vec3_make(0, 0, -distance));
        assert_true(vec3_length(vec3_sub(vec3_of(c->light[k].position), true_place)) < tolerance);
    }
}

static void a_known_distance_is_kept(void **state)
{
    (void)state;
    merlin_capture c;
    ball_capture(&c, false, true, 1);
    c.camera.distance = distance;
    assert_int_equal(pst_place_lights(&c, NULL), OK);
    check_places(&c, 1e-3f);
    assert_true(solved_angle(&c, MERLIN_STEREO_NEAR) < 0.3);
    pst_capture_free(&c);
}

static void places_explain_pictures_that_directions_do_not(void **state)
{
    (void)state;
    merlin_capture c;
    ball_capture(&c, false, false, 1);
    assert_int_equal(pst_place_lights(&c, NULL), OK);
    check_places(&c, 0.03f * distance);
    const warning *told = warnings_find(&c.noticed, "lights_have_places");
    assert_non_null(told);
    assert_non_null(strstr(told->message, "near ones"));
    assert_true(solved_angle(&c, MERLIN_STEREO_NEAR) < 0.5);
    pst_capture_free(&c);
}

/* That of --near, whose field of view is twice the true one. */
static void another_camera_does_nearly_as_well(void **state)
{
    (void)state;
    shows_figures_alone();
    merlin_capture c;
    ball_capture(&c, false, true, 1);
    c.camera = pinhole_of(SIZE, SIZE, 60);
    assert_int_equal(pst_place_lights(&c, NULL), OK);
    assert_int_equal(c.noticed.count, 0);
    assert_true(solved_angle(&c, MERLIN_STEREO_NEAR) < 1);
    pst_capture_free(&c);
}

static void lights_from_afar_stay_directions(void **state)
{
    (void)state;
    merlin_capture c;
    ball_capture(&c, true, false, 1);
    pinhole before = c.camera;
    assert_int_equal(pst_place_lights(&c, NULL), OK);
    assert_int_equal(c.lighting, MERLIN_DISTANT_LIGHTS);
    assert_memory_equal(&c.camera, &before, sizeof before);
    const warning *told = warnings_find(&c.noticed, "lights_have_places");
    assert_non_null(told);
    assert_non_null(strstr(told->message, "directions"));
    assert_true(solved_angle(&c, MERLIN_STEREO_ROBUST) < 0.3);
    pst_capture_free(&c);
}

static void near_lights_whose_distance_nothing_tells_are_refused(void **state)
{
    (void)state;
    merlin_capture c;
    ball_capture(&c, true, true, 1);
    assert_int_equal(pst_place_lights(&c, NULL), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "--distance"));
    pst_capture_free(&c);
    /* but a dome's radius for a unit is the distance of nothing else */
    ball_capture(&c, true, true, 1 / reach);
    assert_int_equal(pst_place_lights(&c, NULL), OK);
    assert_true(fabsf(c.light[0].position[2] - about_ball(0).z / reach + 1) < 1e-3f);
    pst_capture_free(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_known_distance_is_kept),
        cmocka_unit_test(places_explain_pictures_that_directions_do_not),
        cmocka_unit_test(another_camera_does_nearly_as_well),
        cmocka_unit_test(lights_from_afar_stay_directions),
        cmocka_unit_test(near_lights_whose_distance_nothing_tells_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
