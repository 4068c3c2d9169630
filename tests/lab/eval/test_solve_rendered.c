/* SPDX-License-Identifier: MIT */
/* Objects of this project's own renderer: microfacets or a cosine lobe, true cast shadows, indirect light. The peers'
 * best has 3.38 degrees on an object of this kind where least squares has 18.47. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

#include "lab/eval/stereo/rendered_capture.h"
#include "lab/scene/material/material.h"
#include "relief.h"
#include "stereo/integrate/surface_error.h"

/* degrees */
static const double robust_bound = 2.5;

static void generate(uint64_t index, scene_object *object)
{
    assert_int_equal(scene_object_generate(1, index, 60, object), OK);
    /* relief finer than a pixel has no one normal */
    object->material->bumps = 0;
}

static void take(const rendered *how, const scene_object *object, merlin_capture *c)
{
    if (rendered_capture(how, object, c) != OK) fail_msg("%s", status_message());
}

static double rendered_angle(const rendered *how, uint64_t index, merlin_stereo_method method)
{
    scene_object object;
    merlin_capture c;
    generate(index, &object);
    take(how, &object, &c);
    double angle = solve_angle(&c, method);
    print_message("object %d, roughness %.2f, cosine power %.0f, %d paths, field of view %.0f: %s %.2f degrees\n",
                  (int)index, (double)how->roughness, (double)how->exponent, how->paths, (double)how->fov,
                  merlin_stereo_method_name(method), angle);
    scene_object_free(&object);
    pst_capture_free(&c);
    return angle;
}

static const rendered glossy = {
    .size = 64, .lights = 50, .strata = 2, .roughness = 0.35f, .paleness = 0.5f, .exposure = 3};

static void robust_sees_through_microfacets_of_any_roughness(void **state)
{
    (void)state;
    static const float roughness[] = {0.15f, 0.35f, 0.6f, 1};
    for (size_t i = 0; i < sizeof roughness / sizeof *roughness; i++) {
        rendered how = glossy;
        how.roughness = roughness[i];
        assert_true(rendered_angle(&how, 3 + i, MERLIN_STEREO_ROBUST) < robust_bound);
    }
}

static void robust_sees_through_cosine_lobes(void **state)
{
    (void)state;
    rendered how = glossy;
    how.phong = 0.5f;
    how.exponent = 20;
    how.exposure = 1.5f;
    double ls = rendered_angle(&how, 5, MERLIN_STEREO_LS);
    assert_true(ls > 5);
    assert_true(rendered_angle(&how, 5, MERLIN_STEREO_ROBUST) < robust_bound);
}

/* Squares of eight pixels, as on a chessboard, get the other's pictures. */
static void inlay(const merlin_capture *from, merlin_capture *to)
{
    size_t channels = (size_t)to->channels;
    for (int i = 0; i < to->width * to->height; i++) {
        if ((i % to->width / 8 + i / to->width / 8) % 2) continue;
        for (int k = 0; k < to->count; k++)
            memcpy(to->picture[k].wide + (size_t)i * channels, from->picture[k].wide + (size_t)i * channels,
                   channels * sizeof(uint16_t));
    }
}

/* It has 0.23 degrees; one kind of lobe for both has 0.36. */
static void robust_tells_two_materials_apart(void **state)
{
    (void)state;
    scene_object object;
    merlin_capture c, other;
    rendered how = glossy;
    generate(9, &object);
    how.exposure = 2;
    take(&how, &object, &c);
    how.phong = 0.3f;
    how.exponent = 60;
    take(&how, &object, &other);
    inlay(&other, &c);
    double angle = solve_angle(&c, MERLIN_STEREO_ROBUST);
    print_message("object 9 of two materials: %.2f degrees\n", angle);
    assert_true(angle < 0.29);
    scene_object_free(&object);
    pst_capture_free(&c);
    pst_capture_free(&other);
}

/* Highlights follow the view: taken for orthographic, this one is off by degrees. */
static void robust_finds_that_a_picture_has_perspective(void **state)
{
    (void)state;
    rendered how = glossy;
    how.fov = 60;
    assert_true(rendered_angle(&how, 11, MERLIN_STEREO_ROBUST) < robust_bound);
}

static void robust_bears_indirect_light_and_few_bits(void **state)
{
    (void)state;
    rendered how = glossy;
    how.paths = 8;
    how.eight_bit = true;
    assert_true(rendered_angle(&how, 14, MERLIN_STEREO_ROBUST) < 1.35 * robust_bound);
}

/* Strengths of 0.4 to 1, and the same without the directions too, equal strengths then. */
static void unknown_light_is_found_despite_highlights(void **state)
{
    (void)state;
    scene_object object;
    merlin_capture c;
    generate(9, &object);
    take(&glossy, &object, &c);
    c.lighting = MERLIN_UNKNOWN_LIGHTS;
    double uncalibrated = solve_angle(&c, MERLIN_STEREO_AUTO);
    c.lighting = MERLIN_DISTANT_LIGHTS;
    c.intensities_known = false;
    for (int k = 0; k < c.count; k++)
        for (int i = 0; i < c.width * c.height * c.channels; i++)
            c.picture[k].wide[i] = (uint16_t)((float)c.picture[k].wide[i] * (0.4f + 0.15f * (float)(k * 7 % 5)));
    double semi = solve_angle(&c, MERLIN_STEREO_AUTO);
    print_message("object 9: uncalibrated %.2f, semi %.2f degrees\n", uncalibrated, semi);
    assert_true(semi < robust_bound);
    assert_true(uncalibrated < 15);
    scene_object_free(&object);
    pst_capture_free(&c);
}

static void check_leds(uint64_t index, const rendered *how, double angle_bound)
{
    scene_object object;
    merlin_capture c;
    merlin_surface s;
    generate(index, &object);
    take(how, &object, &c);
    assert_int_equal(pst_solve(&c, &(merlin_stereo_params){.method = MERLIN_STEREO_NEAR}, &s), OK);
    double angle = mean_angle(&c, &s.normal), error = depth_mean_error(&s.depth, &c);
    print_message("object %d under %d LEDs: %.2f degrees, depth off by %.2f %%\n", (int)index, c.count, angle,
                  100 * error);
    assert_true(angle < angle_bound);
    assert_true(error < 0.02);
    merlin_surface_free(&s);
    scene_object_free(&object);
    pst_capture_free(&c);
}

/* One to two of the object's sizes away, lobes of 1.5, cast shadows; the bounds are the issue's. */
static void leds_give_normals_and_depth(void **state)
{
    (void)state;
    rendered how = glossy;
    how.leds = true;
    how.fov = 60;
    how.exposure = 0.4f;
    check_leds(7, &how, 5);
    how.matte = true;
    check_leds(7, &how, 2);
}

/* A mug whose handle stands off from it: the handle's distance is in no normal. Off by 4.3 % when normals alone were
 * integrated, by 0.4 % now. */
static void leds_tell_how_far_off_a_handle_stands(void **state)
{
    (void)state;
    rendered how = {.size = 80, .lights = 40, .strata = 2, .fov = 60, .exposure = 0.8f, .grey = true, .leds = true};
    check_leds(0, &how, 1.2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(robust_sees_through_microfacets_of_any_roughness),
        cmocka_unit_test(robust_sees_through_cosine_lobes),
        cmocka_unit_test(robust_tells_two_materials_apart),
        cmocka_unit_test(robust_finds_that_a_picture_has_perspective),
        cmocka_unit_test(robust_bears_indirect_light_and_few_bits),
        cmocka_unit_test(unknown_light_is_found_despite_highlights),
        cmocka_unit_test(leds_give_normals_and_depth),
        cmocka_unit_test(leds_tell_how_far_off_a_handle_stands),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
