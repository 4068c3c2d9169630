/* SPDX-License-Identifier: MIT */
/* Few rays where pixels agree, all rays at edges, and the same coverage as with all rays everywhere. */
#include "lab/render/visibility.h"

#include "shapes.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { SIZE = 64, STRATA = 4 };

static void few_rays_find_the_coverage_of_a_sphere(void **state)
{
    (void)state;
    trace_device *device;
    trace_scene scene;
    visibility *v;
    const camera eye = {.width = SIZE, .height = SIZE, .fov = 60};
    scene_object sphere = shape_sphere(vec3_make(0, 0, -1), 0.35f, 96);
    assert_int_equal(trace_device_new(&device), OK);
    assert_int_equal(trace_scene_new(device, &sphere, shape_grey, 1e6, &scene), OK);
    assert_int_equal(visibility_new(&scene, &eye, STRATA, 7, &v), OK);
    double covered = 0;
    int plain = 0, empty = 0;
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++) {
            pixel_hits seen;
            visibility_pixel(v, x, y, &seen);
            covered += seen.coverage;
            empty += seen.count == 0;
            plain += seen.count == STRATA && seen.coverage == 1;
            for (int i = 0; i < seen.count; i++)
                assert_true(seen.hit[i].distance > 0.6f && seen.hit[i].distance < 1);
        }
    /* the outline is a circle of tangent 0.35/sqrt(1 - 0.35²); 200 pixels at the edge have their share to 1/16 or so */
    double radius = 0.35 / sqrt(1 - 0.35 * 0.35) / tan(3.14159265 / 6) * SIZE / 2;
    assert_true(fabs(covered / (3.14159265 * radius * radius) - 1) < 0.005);
    assert_true(plain > 1000 && empty > 2000);
    assert_true(scene.rays < SIZE * SIZE * STRATA * STRATA / 2);
    visibility_free(v);
    trace_scene_free(&scene);
    trace_device_free(device);
    shape_free(&sphere);
}

/* One plate is in front of another: pixels along the edge see both. */
static void an_edge_between_two_surfaces_gets_all_its_rays(void **state)
{
    (void)state;
    trace_device *device;
    trace_scene scene;
    visibility *v;
    const camera eye = {.width = SIZE, .height = SIZE, .fov = 60};
    shape_quad quads[2] = {{{-2, -2, -2}, {4, 0, 0}, {0, 4, 0}}, {{0.013f, -1, -1}, {1, 0, 0}, {0, 2, 0}}};
    scene_object plates = shape_quads(quads, 2);
    assert_int_equal(trace_device_new(&device), OK);
    assert_int_equal(trace_scene_new(device, &plates, shape_grey, 1e6, &scene), OK);
    assert_int_equal(visibility_new(&scene, &eye, STRATA, 7, &v), OK);
    for (int y = 0; y < SIZE; y++) {
        int most = 0;
        for (int x = 0; x < SIZE; x++) {
            pixel_hits seen;
            visibility_pixel(v, x, y, &seen);
            assert_true(seen.coverage == 1);
            most = seen.count > most ? seen.count : most;
        }
        assert_int_equal(most, STRATA * STRATA);
    }
    visibility_free(v);
    trace_scene_free(&scene);
    trace_device_free(device);
    shape_free(&plates);
}

/* With few expected rays a quick tree is built, with many a good one. */
static void what_rays_meet_does_not_depend_on_how_good_the_tree_is(void **state)
{
    (void)state;
    trace_device *device;
    trace_scene quick, good;
    scene_object sphere = shape_sphere(vec3_make(0.05f, 0, -1), 0.4f, 40);
    assert_int_equal(trace_device_new(&device), OK);
    assert_int_equal(trace_scene_new(device, &sphere, shape_grey, 0, &quick), OK);
    assert_int_equal(trace_scene_new(device, &sphere, shape_grey, 1e9, &good), OK);
    int met = 0;
    for (int i = 0; i < 1000; i++) {
        scene_surface a, b;
        vec3 eye = {0, 0, 0},
             d = vec3_normalize(vec3_make(0.031f * (float)(i % 32 - 16), 0.0313f * (i / 32 - 16.0f), -1));
        bool seen = trace_surface(&quick, eye, d, &a);
        assert_int_equal(seen, trace_surface(&good, eye, d, &b));
        if (seen) assert_true(vec3_length(vec3_sub(a.position, b.position)) < 1e-6f);
        met += seen;
    }
    assert_true(met > 300 && met < 900);
    trace_scene_free(&quick);
    trace_scene_free(&good);
    trace_device_free(device);
    shape_free(&sphere);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(few_rays_find_the_coverage_of_a_sphere),
        cmocka_unit_test(an_edge_between_two_surfaces_gets_all_its_rays),
        cmocka_unit_test(what_rays_meet_does_not_depend_on_how_good_the_tree_is),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
