/* SPDX-License-Identifier: MIT */
#define MERLIN_REAL double
#include "optics/latlong.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static void place_of_a_direction_is_where_it_came_from(void **state)
{
    (void)state;
    for (double u = 0.02; u < 1; u += 0.12)
        for (double v = 0.03; v < 1; v += 0.11) {
            double x, y;
            vec3 d = latlong_direction(u, v);
            assert_true(fabs(vec3_length(d) - 1) < 1e-12);
            latlong_place(d, &x, &y);
            assert_true(fabs(x - u) < 1e-9 && fabs(y - v) < 1e-9);
        }
}

static void middle_column_is_ahead_and_columns_right_of_it_are_right(void **state)
{
    (void)state;
    assert_true(latlong_direction(0.5, 0.5).z < -0.999);
    assert_true(latlong_direction(0.75, 0.5).x > 0.999);
    assert_true(latlong_direction(0.1, 0.001).y > 0.999);
}

static void solid_angles_add_up_to_the_sphere(void **state)
{
    (void)state;
    double sum = 0;
    for (int y = 0; y < 64; y++)
        sum += 128 * latlong_solid_angle(y, 128, 64);
    assert_true(fabs(sum - 4 * PI) < 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(place_of_a_direction_is_where_it_came_from),
        cmocka_unit_test(middle_column_is_ahead_and_columns_right_of_it_are_right),
        cmocka_unit_test(solid_angles_add_up_to_the_sphere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
