/* SPDX-License-Identifier: MIT */
/* Tests what is said of captures under near lights whose distance or lens is not what it is taken for. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "base/status.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

#include "relief.h"
#include "sanitized.h"
#include "stereo/doubts/capture_doubts.h"

enum { SIZE = SANITIZED ? 48 : 72, LIGHTS = 12 };

/* Takes a ball of radius 0.45 at distance 2 in pictures 30 degrees wide, by lamps about the camera. */
static void take_near(merlin_capture *c)
{
    const vec3 middle = {0.05f, -0.03f, -2};
    const float radius = 0.45f;
    capture_new(c, SIZE, LIGHTS, 1);
    c->lighting = MERLIN_NEAR_LIGHTS;
    c->camera = pinhole_of(SIZE, SIZE, 30);
    c->camera.distance = 1.65f;
    for (int k = 0; k < LIGHTS; k++) {
        float phi = 2.4f * (float)k, r = 0.9f * sqrtf(((float)k + 0.7f) / LIGHTS);
        vec3_put(vec3_make(r * cosf(phi), r * sinf(phi), -0.1f - 0.3f * cosf(1.7f * (float)k)), c->light[k].position);
    }
    for (int i = 0; i < SIZE * SIZE; i++) {
        float x = (float)(i % SIZE) + 0.5f - c->camera.x, y = c->camera.y - (float)(i / SIZE) - 0.5f;
        vec3 ray = vec3_normalize(vec3_make(x / c->camera.focal, y / c->camera.focal, -1));
        float along = vec3_dot(ray, middle), under = along * along - vec3_dot(middle, middle) + radius * radius;
        if (under < 0.3f * radius * radius) continue;
        vec3 at = vec3_scale(ray, along - sqrtf(under)), n = vec3_scale(vec3_sub(at, middle), 1 / radius);
        c->mask.data[i] = 1;
        for (int k = 0; k < LIGHTS; k++) {
            vec3 to = vec3_sub(vec3_of(c->light[k].position), at);
            float far = vec3_length(to);
            c->picture[k].wide[i] = relief_code(fmaxf(vec3_dot(n, to), 0) / (far * far * far));
        }
    }
}

static warnings near_doubts_of(const merlin_capture *c)
{
    merlin_surface surface;
    warnings doubts = {0};
    assert_int_equal(pst_solve(c, &(merlin_stereo_params){.method = MERLIN_STEREO_NEAR}, &surface), OK);
    assert_int_equal(pst_doubts(c, &surface, &doubts), OK);
    merlin_surface_free(&surface);
    return doubts;
}

static void another_distance_or_lens_is_named(void **state)
{
    (void)state;
    merlin_capture c;
    take_near(&c);
    warnings doubts = near_doubts_of(&c);
    if (doubts.count) fail_msg("%s: %s", doubts.at[0].code, doubts.at[0].message);
    static const float wrong[] = {0.8f, 3.3f, 16};
    for (size_t i = 0; i < (SANITIZED ? 1 : sizeof wrong / sizeof *wrong); i++) {
        float told = 0;
        c.camera.distance = wrong[i];
        doubts = near_doubts_of(&c);
        const warning *w = warnings_find(&doubts, "other_distance");
        if (!w) fail_msg("at %g: %s", (double)wrong[i], doubts.count ? doubts.at[0].message : "no word");
        assert_int_equal(sscanf(strstr(w->message, "about ") + 6, "%f", &told), 1);
        assert_float_equal(told, 1.65f, 0.2f);
    }
    c.camera = pinhole_of(SIZE, SIZE, 60);
    c.camera.distance = 1.65f;
    doubts = near_doubts_of(&c);
    assert_non_null(warnings_find(&doubts, "other_lens"));
    c.camera = pinhole_of(SIZE, SIZE, 40); /* ten degrees too wide */
    c.camera.distance = 1.65f;
    doubts = near_doubts_of(&c);
    assert_non_null(warnings_find(&doubts, "other_lens"));
    capture_drop(&c);
}

/* A lens that nobody tells is assumed, which is told; one that somebody tells is not. */
static void an_assumed_lens_is_told(void **state)
{
    (void)state;
    merlin_capture c;
    take_near(&c);
    c.camera = (pinhole){.distance = 1.65f};
    pst_capture_see(&c, 0, 0);
    warnings doubts = near_doubts_of(&c);
    assert_non_null(warnings_find(&doubts, "lens_assumed"));
    c.camera = (pinhole){.distance = 1.65f};
    pst_capture_see(&c, 30, 0);
    doubts = near_doubts_of(&c);
    assert_null(warnings_find(&doubts, "lens_assumed"));
    capture_drop(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(another_distance_or_lens_is_named),
        cmocka_unit_test(an_assumed_lens_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
