/* SPDX-License-Identifier: MIT */
/* Tests whether the light of a photograph is told to be at the lens or not: a sphere whose maps are true, under both.
 */
#include "estimate/photo/light_cues.h"
#include "optics/camera.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { SIDE = 128 };
static const float RADIUS = 0.35f;

/* A white sphere about (0, 0, -1): its maps, and room for its photograph. */
typedef struct scene {
    surface maps;
    img photo;
} scene;

static void fill(scene *s)
{
    const camera view = {.width = SIDE, .height = SIDE, .fov = CAMERA_FOV};
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            vec3 ray = camera_point(&view, (float)x + 0.5f, (float)y + 0.5f, 1), middle = vec3_make(0, 0, -1);
            float a = vec3_dot(ray, ray), b = vec3_dot(ray, middle), c = 1 - RADIUS * RADIUS;
            if (b * b < a * c) continue;
            float depth = (b - sqrtf(b * b - a * c)) / a;
            vec3 n = vec3_scale(vec3_sub(vec3_scale(ray, depth), middle), 1 / RADIUS);
            float *normal = img_at(&s->maps.normal, x, y);
            normal[0] = n.x, normal[1] = n.y, normal[2] = n.z;
            *img_at(&s->maps.depth, x, y) = depth;
            *img_at(&s->maps.mask, x, y) = 1;
        }
}

static void open_scene(scene *s)
{
    assert_int_equal(surface_new(SIDE, SIDE, &s->maps), OK);
    assert_int_equal(img_new(&s->photo, SIDE, SIDE, 3), OK);
    fill(s);
}

static void close_scene(scene *s)
{
    surface_free(&s->maps);
    img_free(&s->photo);
}

/* A lamp at a place, and light from everywhere beside it. */
static void light(scene *s, vec3 place, float everywhere)
{
    const camera view = {.width = SIDE, .height = SIDE, .fov = CAMERA_FOV};
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            if (*img_at(&s->maps.mask, x, y) == 0) continue;
            vec3 point = camera_point(&view, (float)x + 0.5f, (float)y + 0.5f, *img_at(&s->maps.depth, x, y));
            vec3 l = vec3_sub(place, point), n = vec3_of(img_at(&s->maps.normal, x, y));
            float square = vec3_dot(l, l), facing = fmaxf(vec3_dot(n, l) / sqrtf(square), 0);
            for (int c = 0; c < 3; c++)
                img_at(&s->photo, x, y)[c] = 0.3f * facing / square + everywhere;
        }
}

static float elsewhere(const scene *s)
{
    const light_frame frame = {0, 0, SIDE, SIDE, 1};
    light_cues cues;
    assert_int_equal(light_cues_find(&s->maps, &s->photo, &frame, &cues), OK);
    assert_true(cues.known);
    return light_cues_elsewhere(&cues);
}

static void a_flash_at_the_lens_is_taken_for_one(void **state)
{
    (void)state;
    scene s;
    open_scene(&s);
    light(&s, vec3_make(0, 0, 0), 0);
    assert_true(elsewhere(&s) < 0.3f);
    light(&s, vec3_make((real)0.03, (real)0.05, 0), 0.01f); /* as on a telephone, in a dim room */
    assert_true(elsewhere(&s) < 0.3f);
    close_scene(&s);
}

static void a_lamp_from_any_side_is_doubted(void **state)
{
    (void)state;
    static const float places[][3] = {{1, 0, -1}, {-1, 0, -1}, {0, 1, -1}, {0, -1, -1}, {0.8f, 0.6f, -0.5f}};
    scene s;
    open_scene(&s);
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        light(&s, vec3_of(places[i]), 0.002f);
        assert_true(elsewhere(&s) > 0.9f);
    }
    close_scene(&s);
}

/* So close that the photograph shows no outline. */
static void nothing_is_said_of_an_object_without_an_outline(void **state)
{
    (void)state;
    scene s;
    open_scene(&s);
    light(&s, vec3_make(1, 0, -1), 0.002f);
    const light_frame frame = {SIDE / 2 - 8, SIDE / 2 - 8, SIDE / 2 + 8, SIDE / 2 + 8, 1};
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            if (x < frame.left || x >= frame.right || y < frame.top || y >= frame.bottom)
                *img_at(&s.maps.mask, x, y) = 0;
    light_cues cues;
    assert_int_equal(light_cues_find(&s.maps, &s.photo, &frame, &cues), OK);
    assert_false(cues.known);
    assert_true(light_cues_elsewhere(&cues) == 0);
    close_scene(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_flash_at_the_lens_is_taken_for_one),
        cmocka_unit_test(a_lamp_from_any_side_is_doubted),
        cmocka_unit_test(nothing_is_said_of_an_object_without_an_outline),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
