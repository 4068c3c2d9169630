/* SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

#include "photo_stereo/further_light.h"

static void it_is_in_front_and_of_length_1(vec3 l)
{
    assert_true(vec3_length(l) > 0.999f && vec3_length(l) < 1.001f);
    assert_true(l.z > 0.49f);
}

static void it_is_on_the_side_that_is_missing(void **state)
{
    (void)state;
    const vec3 lights[] = {{0, 0, 1}, {-0.7f, 0, 0.7f}, {-0.5f, 0.5f, 0.7f}, {-0.5f, -0.5f, 0.7f}};
    const vec3 found = further_light(lights, 4);
    it_is_in_front_and_of_length_1(found);
    assert_true(found.x > 0.6f);
}

/* The third light is out of the plane of two. */
static void it_leaves_the_plane_of_the_others(void **state)
{
    (void)state;
    const vec3 lights[] = {{0.6f, 0, 0.8f}, {-0.6f, 0, 0.8f}};
    const vec3 found = further_light(lights, 2);
    it_is_in_front_and_of_length_1(found);
    assert_true(found.y > 0.7f || found.y < -0.7f);
}

/* A light that is hardly known does not count. */
static void unsure_lights_count_less(void **state)
{
    (void)state;
    const vec3 lights[] = {{0.6f, 0, 0.8f}, {-0.6f, 0, 0.8f}, {0, 0.06f, 0.08f}, {0, -0.6f, 0.8f}};
    const vec3 found = further_light(lights, 4);
    it_is_in_front_and_of_length_1(found);
    assert_true(found.y > 0.6f);
}

static void none_are_no_fault(void **state)
{
    (void)state;
    it_is_in_front_and_of_length_1(further_light(NULL, 0));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_is_on_the_side_that_is_missing),
        cmocka_unit_test(it_leaves_the_plane_of_the_others),
        cmocka_unit_test(unsure_lights_count_less),
        cmocka_unit_test(none_are_no_fault),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
