/* SPDX-License-Identifier: MIT */
#include "optics/blackbody.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

/* The sRGB codes of black bodies by the CIE 1931 observer are listed in published tables to a few codes. */
static void temperatures_have_their_colours(void **state)
{
    (void)state;
    const struct {
        double kelvin;
        float green, blue; /* linear, red being 1 */
    } known[] = {{2000, 0.251f, 0.006f}, {2700, 0.397f, 0.095f}, {4000, 0.638f, 0.369f}, {6500, 0.947f, 0.982f}};
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        vec3 c = blackbody_color(known[i].kelvin);
        assert_float_equal(c.x, 1, 1e-6);
        assert_float_equal(c.y, known[i].green, 0.03);
        assert_float_equal(c.z, known[i].blue, 0.03);
    }
    vec3 sky = blackbody_color(20000);
    assert_true(sky.z == 1 && sky.x < sky.y && sky.y < 1);
    vec3 ember = blackbody_color(1000);
    assert_true(ember.x == 1 && ember.y < 0.1f && ember.z == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(temperatures_have_their_colours),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
