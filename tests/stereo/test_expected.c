/* SPDX-License-Identifier: MIT */
/* Unknown lights about an object that is expected from elsewhere, such as by a network: pst_solve_expecting. */
#include "base/rng.h"
#include "solve_fixture.h"

enum { SIZE = 64, LIGHTS = 12 };
static const relief painted = {.size = SIZE, .lights = LIGHTS, .channels = 3, .exposure = 1.5f};

typedef struct expectation {
    img normal;
    vec3 light[LIGHTS];
} expectation;

/* The sphere, whose colours vary, under lights of strengths from 0.8 to 1. */
static void dim_some(merlin_capture *c)
{
    for (int k = 0; k < LIGHTS; k++)
        for (int i = 0; i < c->width * c->height * c->channels; i++)
            c->picture[k][i] = (uint16_t)((float)c->picture[k][i] * (0.8f + 0.2f * (float)(k * 7 % 5) / 4));
    pst_capture_forget_lights(c);
    c->intensities_known = false;
}

/* Makes what a network may expect: flatter by this factor, and lights off by some 20 degrees. */
static void expect(const merlin_capture *c, const vec3 *light, float flatter, expectation *out)
{
    rng r = rng_at(8, 0, 0);
    assert_int_equal(img_copy(&out->normal, &c->normal_true), OK);
    for (int i = 0; i < SIZE * SIZE; i++) {
        float *n = out->normal.data + 3 * i;
        if (c->mask.data[i] == 0) continue;
        vec3_put(vec3_normalize(vec3_make(n[0] * flatter, n[1] * flatter, n[2])), n);
    }
    for (int k = 0; k < LIGHTS; k++) {
        vec3 off = vec3_make(rng_range(&r, -0.3f, 0.3f), rng_range(&r, -0.3f, 0.3f), 0);
        out->light[k] = vec3_normalize(vec3_add(light[k], off));
    }
}

static double solve_expecting(const merlin_capture *c, const expectation *e, bool *unsure)
{
    merlin_surface s;
    const merlin_stereo_params params = {.method = MERLIN_STEREO_UNCALIBRATED, .unchecked = 1};
    if (pst_solve_expecting(c, &params, &(pst_expected){&e->normal, e->light}, &s) != OK)
        fail_msg("%s", status_message());
    const double angle = mean_angle(c, &s.normal);
    *unsure = s.lights_unsure;
    merlin_surface_free(&s);
    print_message("%.2f degrees%s\n", angle, *unsure ? ", unsure" : "");
    return angle;
}

/* Lights that are not quite equally strong mislead whoever relies on their strengths alone. */
static void an_expected_surface_decides_what_strengths_do_not(void **state)
{
    (void)state;
    merlin_capture c;
    merlin_surface s;
    vec3 light[LIGHTS];
    bool unsure;
    relief_capture(&painted, &c);
    for (int k = 0; k < LIGHTS; k++)
        light[k] = vec3_of(c.light[k].direction);
    dim_some(&c);
    assert_int_equal(pst_solve(&c, &(merlin_stereo_params){.method = MERLIN_STEREO_UNCALIBRATED}, &s), OK);
    const double plain = mean_angle(&c, &s.normal);
    merlin_surface_free(&s);
    print_message("%.2f degrees by strengths alone\n", plain);
    assert_true(plain > 5);
    expectation e;
    expect(&c, light, 0.6f, &e);
    const double expected = mean_angle(&c, &e.normal);
    assert_true(expected > 9);
    assert_true(solve_expecting(&c, &e, &unsure) < 4.6);
    assert_false(unsure);
    img_free(&e.normal);
    capture_drop(&c);
}

/* The network sees other lights than there can be: the pictures and it contradict each other. */
static void lights_that_nobody_expects_are_unsure(void **state)
{
    (void)state;
    merlin_capture c;
    vec3 light[LIGHTS];
    bool unsure;
    relief_capture(&painted, &c);
    for (int k = 0; k < LIGHTS; k++) {
        const float *d = c.light[(k + LIGHTS / 2) % LIGHTS].direction;
        light[k] = vec3_make(-d[1], d[0], d[2]);
    }
    dim_some(&c);
    expectation e;
    expect(&c, light, 1, &e);
    solve_expecting(&c, &e, &unsure);
    assert_true(unsure);
    img_free(&e.normal);
    capture_drop(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_expected_surface_decides_what_strengths_do_not),
        cmocka_unit_test(lights_that_nobody_expects_are_unsure),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
