/* SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

#include "ball.h"
#include "stereo/doubts/model_check.h"
#include "stereo/fit/field_fit.h"

enum { SIZE = BALL_SIZE, LIGHTS = 32 };

/* Positions on two rings about the camera, one to two diameters from the ball. */
static vec3 led_position(int i)
{
    float phi = 6.2831853f * (float)i / (LIGHTS / 2.0f), ring = i % 2 ? 0.3f : 0.65f;
    return vec3_make(ring * cosf(phi), ring * sinf(phi), i % 2 ? -0.15f : -0.4f);
}

static float ball_under_leds(merlin_capture *c, float specular)
{
    return ball_capture(c, LIGHTS, led_position, 1.5f, specular);
}

/* Largest error of the depth against its truth, once the scale is aligned; *scale is what was left to align. */
static double depth_error(const merlin_capture *c, const img *depth, double *scale)
{
    double product = 0, square = 0, most = 0;
    for (int i = 0; i < SIZE * SIZE; i++) {
        if (c->mask.data[i] < 0.5f) continue;
        product += (double)depth->data[i] * c->depth_true.data[i];
        square += (double)depth->data[i] * depth->data[i];
    }
    *scale = product / square;
    for (int i = 0; i < SIZE * SIZE; i++)
        if (c->mask.data[i] > 0.5f)
            most = fmax(most, fabs(depth->data[i] * *scale / (double)c->depth_true.data[i] - 1));
    return most;
}

static void check_ball(float specular, bool distance_known, double angle_bound, double scale_bound)
{
    merlin_capture c;
    merlin_surface s;
    double scale;
    float mean = ball_under_leds(&c, specular);
    if (distance_known) c.camera.distance = mean;
    assert_int_equal(pst_solve(&c, &(merlin_stereo_params){.method = MERLIN_STEREO_AUTO}, &s), OK);
    assert_int_equal(s.method, MERLIN_STEREO_NEAR);
    double angle = mean_angle(&c, &s.normal), error = depth_error(&c, &s.depth, &scale);
    print_message("near, specular %.0f, distance %s: %.2f degrees, depth %.2f %%, scale %.3f\n", (double)specular,
                  distance_known ? "known" : "from the lights", angle, 100 * error, scale);
    assert_true(angle < angle_bound);
    assert_true(error < 0.02);
    assert_true(fabs(scale - 1) < scale_bound);
    merlin_surface_free(&s);
    capture_drop(&c);
}

/* The bounds are the issue's. */
static void near_lights_give_normals_and_depth(void **state)
{
    (void)state;
    check_ball(0, true, 2, 0.02);
}

static void near_lights_see_through_highlights(void **state)
{
    (void)state;
    check_ball(4, true, 5, 0.02);
}

/* Without a known distance the inverse-square law gives it, to a few percent. */
static void near_lights_give_the_distance_too(void **state)
{
    (void)state;
    check_ball(0, false, 2, 0.05);
}

/* The ball under some of the lights, spread evenly over all of them or over the outer ring. */
typedef struct few_leds {
    int count;
    bool outer;
    float specular, distance_off; /* what the distance is said to be, as a factor on the true one; 0: nothing is said */
} few_leds;

static void few_capture(const few_leds *few, merlin_capture *c)
{
    float mean = ball_under_leds(c, few->specular);
    c->camera.distance = few->distance_off * mean;
    for (int k = 0; k < few->count; k++) {
        int from = LIGHTS / 2 * k / few->count;
        if (few->outer) from -= from % 2;
        c->light[k] = c->light[from];
        memcpy(c->picture[k].wide, c->picture[from].wide, SIZE * SIZE * sizeof(uint16_t));
    }
    for (int k = few->count; k < LIGHTS; k++)
        pst_plane_free(&c->picture[k]);
    c->count = few->count;
}

static bool doubts_distance(const few_leds *few, double *angle)
{
    merlin_capture c;
    merlin_surface s;
    few_capture(few, &c);
    assert_int_equal(pst_solve(&c, &(merlin_stereo_params){.method = MERLIN_STEREO_AUTO}, &s), OK);
    bool unsure = s.distance_unsure;
    *angle = mean_angle(&c, &s.normal);
    print_message("%d lights, specular %.0f: %.2f degrees%s\n", few->count, (double)few->specular, *angle,
                  unsure ? ", unsure" : "");
    if (few->distance_off > 0) {
        double scale;
        depth_error(&c, &s.depth, &scale);
        assert_float_equal(scale * (double)few->distance_off, 1, 2e-3);
    }
    merlin_surface_free(&s);
    capture_drop(&c);
    return unsure;
}

/* Three values of a pixel are explained from anywhere, and those of a ring about the lens nearly so: what is found then
 * is a guess, 9 to 27 degrees off, and may be any other on another machine. Where the distance is known to three
 * percent normals are off by 6 at most (10 under three lights). What is said of it holds. */
static void a_ring_of_lights_does_not_tell_the_distance(void **state)
{
    (void)state;
    double angle;
    for (int count = 3; count <= 4; count++)
        for (int glossy = 0; glossy < 2; glossy++) {
            few_leds few = {count, true, 4 * (float)glossy, 0};
            assert_true(doubts_distance(&few, &angle));
            few.distance_off = 1.03f;
            assert_false(doubts_distance(&few, &angle));
            assert_true(angle < (count == 3 ? 10 : 6));
        }
    assert_true(doubts_distance(&(few_leds){8, true, 0, 0}, &angle));
}

static void two_rings_of_lights_tell_the_distance(void **state)
{
    (void)state;
    static const int counts[] = {5, 6, 7, 9, 11, 16};
    double angle;
    for (int i = 0; i < 6; i++)
        for (int glossy = 0; glossy < 2; glossy++)
            assert_false(doubts_distance(&(few_leds){counts[i], false, 4 * (float)glossy, 0}, &angle));
}

/* One pixel's fit is turned away and its cost left; it comes back, and no other pixel changes. */
static void a_lone_pixel_is_fitted_again_from_its_neighbours(void **state)
{
    (void)state;
    merlin_capture c;
    double cost;
    ball_under_leds(&c, 0);
    pst_problem p = {.capture = &c, .light = c.light, .saturation = PST_SATURATED};
    assert_int_equal(pst_list_pixels(&c, &p), OK);
    pst_lobe lobe = {.width = 0.04f, .shadow = PST_SHADOW_COST, .masking = 0.28f};
    pst_shading *shading = calloc(2 * p.pixel_count, sizeof *shading), *before = shading + p.pixel_count;
    pst_field f = {.problem = &p,
                   .pixel = p.pixel,
                   .count = p.pixel_count,
                   .depth = &c.depth_true,
                   .scale = 1,
                   .lobe = &lobe,
                   .shading = shading};
    assert_int_equal(pst_field_fit(&f, &cost), OK);
    memcpy(before, shading, p.pixel_count * sizeof *shading);
    size_t lone = p.pixel_count / 2;
    shading[lone].normal = vec3_make(0.8f, 0, 0.6f);
    assert_int_equal(pst_field_replace_outliers(&f, 1), OK);
    for (size_t i = 0; i < p.pixel_count; i++)
        assert_true(vec3_dot(shading[i].normal, before[i].normal) > (i == lone ? 0.9998f : 0.999999f));
    free(shading);
    free(p.pixel);
    capture_drop(&c);
}

/* A bar of LEDs, bent by a hundredth of its half: what it does not light from leaves normals 30 degrees off. */
static void near_lights_on_a_line_are_refused(void **state)
{
    (void)state;
    merlin_capture c;
    merlin_surface s;
    ball_under_leds(&c, 0);
    for (int k = 0; k < LIGHTS; k++) {
        float along = 2 * (float)k / (LIGHTS - 1) - 1;
        vec3_put(vec3_make(300 * along, 200, -100 + 3 * (float)(k % 2)), c.light[k].position);
    }
    assert_int_equal(pst_solve(&c, &(merlin_stereo_params){.method = MERLIN_STEREO_AUTO}, &s), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "on one line"));
    capture_drop(&c);
}

static void a_near_capture_without_focal_length_is_refused(void **state)
{
    (void)state;
    merlin_capture c;
    merlin_surface s;
    ball_under_leds(&c, 0);
    c.camera.focal = 0;
    assert_int_equal(pst_solve(&c, &(merlin_stereo_params){.method = MERLIN_STEREO_NEAR}, &s), MERLIN_WRONG_USE);
    assert_non_null(strstr(status_message(), "focal length"));
    capture_drop(&c);
}

/* A surface that a guide tells, and the distance that the guide was told. */
typedef struct told {
    const img *normal, *depth;
    float mean, distance; /* of the depth, and the camera's */
} told;

static status tell(const void *context, const merlin_capture *c, const watch *w, img *normal, img *depth)
{
    const told *t = context;
    (void)w;
    ((told *)context)->distance = c->camera.distance;
    status s = img_copy(normal, t->normal);
    if (s == OK) s = img_copy(depth, t->depth);
    for (size_t i = 0; s == OK && i < img_value_count(depth); i++)
        depth->data[i] *= c->camera.distance / t->mean;
    return s;
}

/* The ball's own surface is taken as it is, its matte albedo is measured, and a highlight does not add to that. */
static void a_surface_that_is_told_gets_its_albedo(void **state)
{
    (void)state;
    merlin_capture c;
    merlin_surface s;
    const float mean = ball_under_leds(&c, 1);
    told t = {&c.normal_true, &c.depth_true, mean, 0};
    const merlin_stereo_params params = {.method = MERLIN_STEREO_NFPS};
    assert_int_equal(pst_solve(&c, &params, &s), MERLIN_WRONG_USE);
    assert_int_equal(pst_solve_guided(&c, &params, &(pst_guide){.find = tell, .context = &t}, &s), OK);
    print_message("distance %.3f of %.3f\n", (double)t.distance, (double)mean);
    assert_true(fabsf(t.distance / mean - 1) < 0.03f); /* nobody told it, so the lights do */
    assert_true(mean_angle(&c, &s.normal) < 0.1);
    double sum = 0, count = 0;
    for (int i = 0; i < SIZE * SIZE; i++) {
        assert_true(fabsf(s.depth.data[i] - c.depth_true.data[i] * t.distance / mean) < 1e-5f);
        sum += (double)s.albedo.data[i];
        count += (double)c.mask.data[i];
    }
    assert_true(fabs(sum / count / (0.36 / M_PI) - 1) < 0.15);
    warnings doubts = {0};
    assert_int_equal(pst_check_model(&c, &s, &doubts), OK);
    assert_null(warnings_find(&doubts, "lights_do_not_fit"));
    merlin_surface_free(&s);
    capture_drop(&c);
}

/* A search that begins elsewhere, too, finds nothing worse. */
static void a_guide_who_is_wrong_does_no_harm(void **state)
{
    (void)state;
    merlin_capture c;
    merlin_surface s;
    img normal, depth;
    const float mean = ball_under_leds(&c, 0);
    c.camera.distance = mean;
    assert_int_equal(img_copy(&normal, &c.normal_true), OK);
    assert_int_equal(img_copy(&depth, &c.depth_true), OK);
    for (int i = 0; i < SIZE * SIZE; i++) { /* a bowl instead of a ball */
        if (c.mask.data[i] > 0.5f) depth.data[i] = 2 * mean - depth.data[i];
        normal.data[3 * i] *= -1;
        normal.data[3 * i + 1] *= -1;
    }
    told t = {&normal, &depth, mean, 0};
    assert_int_equal(pst_solve_guided(&c, &(merlin_stereo_params){0}, &(pst_guide){.find = tell, .context = &t}, &s),
                     OK);
    assert_int_equal(s.method, MERLIN_STEREO_NEAR);
    assert_true(t.distance == mean);
    assert_true(mean_angle(&c, &s.normal) < 2);
    img_free(&normal);
    img_free(&depth);
    merlin_surface_free(&s);
    capture_drop(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(near_lights_give_normals_and_depth),
        cmocka_unit_test(near_lights_see_through_highlights),
        cmocka_unit_test(near_lights_give_the_distance_too),
        cmocka_unit_test(a_lone_pixel_is_fitted_again_from_its_neighbours),
        cmocka_unit_test(a_ring_of_lights_does_not_tell_the_distance),
        cmocka_unit_test(two_rings_of_lights_tell_the_distance),
        cmocka_unit_test(near_lights_on_a_line_are_refused),
        cmocka_unit_test(a_surface_that_is_told_gets_its_albedo),
        cmocka_unit_test(a_guide_who_is_wrong_does_no_harm),
        cmocka_unit_test(a_near_capture_without_focal_length_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
