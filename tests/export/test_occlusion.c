/* SPDX-License-Identifier: MIT */
/* Ambient occlusion of surfaces for which it is known in closed form. */
#include <math.h>

#include "export/occlusion.h"
#include "spheres.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

typedef struct statistics {
    double mean, spread, lowest;
} statistics;

/* Measures pixels whose normals are not nearly at right angles to the line of sight. */
static statistics over_object(const surface *s, const img *occlusion)
{
    double sum = 0, square = 0, count = 0, lowest = 1;
    for (int i = 0; i < SPHERES_PIXELS; i++) {
        vec3 n = vec3_of(s->normal.data + 3 * i);
        if (s->mask.data[i] < 0.5f || vec3_dot(n, vec3_normalize(spheres_ray(i))) > -0.3f) continue;
        double x = (double)occlusion->data[i];
        sum += x;
        square += x * x;
        count++;
        lowest = fmin(lowest, x);
    }
    assert_true(count > 1000);
    return (statistics){sum / count, sqrt(fmax(square / count - sum * sum / count / count, 0)), lowest};
}

static void a_plane_is_open_everywhere(void **state)
{
    (void)state;
    surface s;
    img occlusion;
    assert_int_equal(surface_new(SPHERES_SIDE, SPHERES_SIDE, &s), OK);
    for (int i = 0; i < SPHERES_PIXELS; i++)
        spheres_put_pixel(&s, i, 1, vec3_make(0, 0, 1));
    assert_int_equal(occlusion_of(&s, &s, &occlusion), OK);
    statistics of = over_object(&s, &occlusion);
    print_message("plane: %.3f, lowest %.3f\n", of.mean, of.lowest);
    /* of 64 directions the outermost graze it, and are half hidden by the horizon's soft edge */
    assert_true(of.mean > 0.98 && of.lowest > 0.95);
    img_free(&occlusion);
    surface_free(&s);
}

static void a_ball_is_open_and_its_surroundings_are_one(void **state)
{
    (void)state;
    surface s;
    img occlusion;
    assert_int_equal(surface_new(SPHERES_SIDE, SPHERES_SIDE, &s), OK);
    spheres_put(&s, vec3_make(0, 0, -1), 0.35f, false, 0);
    assert_int_equal(occlusion_of(&s, &s, &occlusion), OK);
    statistics of = over_object(&s, &occlusion);
    print_message("ball: %.3f, lowest %.3f\n", of.mean, of.lowest);
    assert_true(of.mean > 0.98 && of.lowest > 0.9);
    assert_float_equal(occlusion.data[0], 1, 0);
    img_free(&occlusion);
    surface_free(&s);
}

/* Every piece of a sphere is seen from inside under the same factor, its share of the sphere's area: all points of a
 * bowl that is cut from a sphere see the missing part. */
static void all_of_a_bowl_sees_the_missing_part_of_its_sphere(void **state)
{
    (void)state;
    const float deeper = 0.3f;
    const double expected = (double)(1 + deeper) / 2;
    surface s;
    img occlusion;
    assert_int_equal(surface_new(SPHERES_SIDE, SPHERES_SIDE, &s), OK);
    spheres_put(&s, vec3_make(0, 0, -1.1f), 0.4f, true, deeper);
    assert_int_equal(occlusion_of(&s, &s, &occlusion), OK);
    statistics of = over_object(&s, &occlusion);
    print_message("bowl: %.3f of %.3f, spread %.3f\n", of.mean, expected, of.spread);
    /* a pixel of margin and half of one at the rim, seen under 0.01 radians each from the middle: 0.02; and as much for
     * the horizon's soft edge, which 1024 directions have, too */
    assert_true(fabs(of.mean - expected) < 0.04);
    assert_true(of.spread < 0.04);
    img_free(&occlusion);
    surface_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_plane_is_open_everywhere),
        cmocka_unit_test(a_ball_is_open_and_its_surroundings_are_one),
        cmocka_unit_test(all_of_a_bowl_sees_the_missing_part_of_its_sphere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
