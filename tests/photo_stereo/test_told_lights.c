/* SPDX-License-Identifier: MIT */
/* lights_of_capture with weights that ship: a ball under near lights. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "merlin/model.h"
#include "photo_stereo/maps_from_capture.h"
#include "stereo/capture/capture.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "ball.h"

enum { LIGHTS = 12 };
#define MODELS MERLIN_SOURCE_DIR "/models/"

static vec3 position(int k)
{
    const float angle = 2.4f * (float)k, aside = 0.25f + 0.05f * (float)k;
    return vec3_make(aside * cosf(angle), aside * sinf(angle), 0.02f * (float)k - 0.1f);
}

static merlin_model *model_with(bool several)
{
    merlin_model *m = NULL;
    merlin_status s = merlin_model_open(MODELS "merlin-any.safetensors", &m);
    if (s == MERLIN_OK && several) s = merlin_model_add_several(m, MODELS "merlin-several.safetensors");
    if (s != MERLIN_OK) fail_msg("%s", merlin_error());
    return m;
}

/* A ball shows lights well: rendered objects have 10 degrees (docs/notes/several_photographs.md). */
static void lights_are_told_by_comparing_pictures(void **state)
{
    (void)state;
    merlin_capture c;
    merlin_light told[LIGHTS] = {0};
    merlin_model *m = model_with(true);
    const float distance = ball_capture(&c, LIGHTS, position, 0, 0.5f);
    c.camera.distance = 3 * distance; /* another unit than the ball's */
    if (lights_of_capture(m, &c, NULL, told) != OK) fail_msg("%s", status_message());
    double angle = 0;
    for (int k = 0; k < LIGHTS; k++) {
        const vec3 middle = {0, 0, -distance}, is = vec3_sub(position(k), middle);
        const vec3 was = vec3_sub(vec3_scale(vec3_of(told[k].position), 1.0f / 3), middle);
        angle += acos(fmin((double)vec3_dot(vec3_normalize(is), vec3_normalize(was)), 1)) * 57.29578 / LIGHTS;
        const float ratio = vec3_length(was) / vec3_length(is);
        assert_true(ratio > 0.4f && ratio < 2.5f);
    }
    print_message("the lights are off by %.1f degrees\n", angle);
    assert_true(angle < 12);
    pst_capture_free(&c);
    merlin_model_close(m);
}

static void it_says_what_it_cannot_do(void **state)
{
    (void)state;
    merlin_capture c;
    merlin_light told[LIGHTS];
    merlin_model *m = model_with(false);
    ball_capture(&c, LIGHTS, position, 0, 0);
    assert_int_equal(lights_of_capture(m, &c, NULL, told), MERLIN_WRONG_USE);
    pst_capture_free(&c);
    merlin_model_close(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lights_are_told_by_comparing_pictures),
        cmocka_unit_test(it_says_what_it_cannot_do),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
