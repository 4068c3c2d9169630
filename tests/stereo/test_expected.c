/* SPDX-License-Identifier: MIT */
/* Unknown lights about an object that is expected from elsewhere, such as by a network: pst_solve_expecting. */
#include "base/rng.h"
#include "solve_fixture.h"

#include "ball.h"

enum { SIZE = 64, LIGHTS = 12 };
static const merlin_stereo_params unknown = {.method = MERLIN_STEREO_UNCALIBRATED, .unchecked = 1};
static const relief painted = {.size = SIZE, .lights = LIGHTS, .channels = 3, .exposure = 1.5f};

typedef struct expectation {
    img normal;
    vec3 light[LIGHTS];
} expectation;

static float share_of(int k, float least)
{
    return least + (1 - least) * (float)(k * 7 % 5) / 4;
}

/* Dims the pictures to shares from `least` to 1, as weaker lights or a camera that is left to itself do. */
static void dim_some(merlin_capture *c, float least)
{
    for (int k = 0; k < LIGHTS; k++)
        for (int i = 0; i < c->width * c->height * c->channels; i++)
            c->picture[k].wide[i] = (uint16_t)((float)c->picture[k].wide[i] * share_of(k, least));
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

typedef struct solution {
    double angle;
    bool unsure, unequal; /* lights_unsure and strengths_unsure */
} solution;

static solution solve_with(const merlin_capture *c, const pst_expected *expected)
{
    merlin_surface s;
    if (pst_solve_expecting(c, &unknown, expected, &s) != OK) fail_msg("%s", status_message());
    const solution found = {mean_angle(c, &s.normal), s.lights_unsure, s.strengths_unsure};
    merlin_surface_free(&s);
    print_message("%d pictures: %.2f degrees%s%s\n", c->count, found.angle, found.unsure ? ", unsure" : "",
                  found.unequal ? ", strengths unequal" : "");
    return found;
}

static double solve_expecting(const merlin_capture *c, const expectation *e, bool *unsure)
{
    const solution found = solve_with(c, &(pst_expected){.normal = &e->normal, .light = e->light});
    *unsure = found.unsure;
    return found.angle;
}

static bool strengths_are_doubted(const merlin_capture *c, const expectation *e, double *angle)
{
    const solution found = solve_with(c, &(pst_expected){.normal = &e->normal, .light = e->light});
    *angle = found.angle;
    return found.unequal;
}

/* Pictures the sphere, whose colours vary, under lights that are not told, and what is expected of both. */
static void picture_painted(merlin_capture *c, expectation *e)
{
    vec3 light[LIGHTS];
    relief_capture(&painted, c);
    for (int k = 0; k < LIGHTS; k++)
        light[k] = vec3_of(c->light[k].direction);
    pst_capture_forget_lights(c);
    expect(c, light, 0.6f, e);
}

/* Lights of one strength are found as such; exposures that differ, which nothing tells, do not pass for them. */
static void exposures_that_nothing_tells_are_doubted(void **state)
{
    (void)state;
    merlin_capture c;
    double angle;
    expectation e;
    picture_painted(&c, &e);
    assert_false(strengths_are_doubted(&c, &e, &angle));
    assert_true(angle < 4);
    dim_some(&c, 0.4f);
    assert_true(strengths_are_doubted(&c, &e, &angle));
    assert_true(angle < 8);
    img_free(&e.normal);
    capture_drop(&c);
}

/* Five pictures by a camera far away. */
static double solve_five(const merlin_capture *c, const expectation *e, const img *flat, bool *unequal)
{
    enum { FIVE = 5 };
    static const float near[FIVE] = {0.8f, 0.8f, 0.8f, 0.8f, 0.8f};
    merlin_capture few = *c;
    few.count = FIVE;
    const solution found = solve_with(
        &few,
        &(pst_expected){.normal = &e->normal, .depth = flat, .light = e->light, .compared = e->light, .near = near});
    *unequal = found.unequal;
    assert_false(found.unsure);
    return found.angle;
}

static void few_pictures_from_far_away_have_distant_lights(void **state)
{
    (void)state;
    merlin_capture c;
    expectation e;
    img flat;
    bool unequal;
    picture_painted(&c, &e);
    assert_int_equal(img_copy(&flat, &c.mask), OK);
    const double expected = mean_angle(&c, &e.normal);
    print_message("expected: %.2f degrees\n", expected);
    assert_true(solve_five(&c, &e, &flat, &unequal) < 0.7 * expected);
    assert_false(unequal);
    dim_some(&c, 0.4f);
    assert_true(solve_five(&c, &e, &flat, &unequal) < expected);
    assert_true(unequal);
    img_free(&flat);
    img_free(&e.normal);
    capture_drop(&c);
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
    dim_some(&c, 0.8f);
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
    dim_some(&c, 0.8f);
    expectation e;
    expect(&c, light, 1, &e);
    solve_expecting(&c, &e, &unsure);
    assert_true(unsure);
    img_free(&e.normal);
    capture_drop(&c);
}

/* ---- few near lights ---- */

enum { FEW = 4 };

static vec3 torch(int i)
{
    const float turn = 0.5f + 6.2831853f * (float)i / FEW, aside = 0.55f + 0.05f * (float)(i % 2);
    return vec3_make(aside * cosf(turn), aside * sinf(turn), -0.2f);
}

/* A surface that is too flat, and four pictures, of which it alone explains none. */
static void few_pictures_correct_what_is_expected(void **state)
{
    (void)state;
    merlin_capture c;
    merlin_surface s;
    ball_expectation e;
    ball_photograph(&c, FEW, torch, 0.6f, &e);
    const pst_expected expected = ball_as_expected(&e);
    assert_int_equal(pst_solve_expecting(&c, &unknown, &expected, &s), OK);
    const double before = mean_angle(&c, &e.normal), after = mean_angle(&c, &s.normal);
    print_message("four pictures: %.2f degrees, expected %.2f\n", after, before);
    assert_true(before > 8 && after < 0.6 * before);
    assert_false(s.lights_unsure);
    merlin_surface_free(&s);
    /* without the lights' distances so few are refused, as they are without anything */
    const pst_expected coarse = {.normal = &e.normal, .light = e.light};
    assert_int_equal(pst_solve_expecting(&c, &unknown, &coarse, &s), MERLIN_BAD_INPUT);
    assert_int_equal(pst_solve(&c, &unknown, &s), MERLIN_BAD_INPUT);
    c.count = 1;
    assert_int_equal(pst_solve_expecting(&c, &unknown, &expected, &s), MERLIN_BAD_INPUT);
    c.count = FEW;
    ball_put_away(&c, &e);
}

/* No surface explains pictures that have other marks each. */
static void few_pictures_of_several_objects_are_unsure(void **state)
{
    (void)state;
    merlin_capture c;
    merlin_surface s;
    ball_expectation e;
    ball_photograph(&c, FEW, torch, 0.6f, &e);
    for (int k = 0; k < FEW; k++)
        for (int i = 0; i < BALL_SIZE * BALL_SIZE; i++) {
            rng r = rng_at(3, (uint64_t)(i / BALL_SIZE / 12 * 100 + i % BALL_SIZE / 12), (uint64_t)k);
            if (rng_uniform(&r) < 0.5f) c.picture[k].wide[i] = (uint16_t)(c.picture[k].wide[i] / 4);
        }
    const pst_expected expected = ball_as_expected(&e);
    assert_int_equal(pst_solve_expecting(&c, &unknown, &expected, &s), OK);
    assert_true(s.lights_unsure);
    merlin_surface_free(&s);
    ball_put_away(&c, &e);
}

/* ---- many near lights ---- */

static vec3 lamp(int i)
{
    return ball_lamp(i, LIGHTS);
}

/* Returns the largest error of the lights' strengths, relative to their mean. */
static float worst_strength(const merlin_surface *s, float least)
{
    float mean = 0, worst = 0;
    for (int k = 0; k < LIGHTS; k++)
        mean += share_of(k, least) / LIGHTS;
    for (int k = 0; k < LIGHTS; k++)
        worst = fmaxf(worst, fabsf(s->lights[k].intensity[0] * mean / share_of(k, least) - 1));
    return worst;
}

/* Exposures that differ are not taken for distances, and those that do not are not taken for such. */
static void strengths_of_near_lights_are_found(void **state)
{
    (void)state;
    merlin_capture c;
    merlin_surface s;
    ball_expectation e;
    ball_photograph(&c, LIGHTS, lamp, 0.6f, &e);
    const pst_expected expected = ball_as_expected(&e);
    const solution even = solve_with(&c, &expected);
    assert_true(even.angle < 3);
    assert_false(even.unequal);
    dim_some(&c, 0.4f);
    assert_int_equal(pst_solve_expecting(&c, &unknown, &expected, &s), OK);
    print_message("dimmed: %.2f degrees, strengths off by up to %.3f\n", mean_angle(&c, &s.normal),
                  (double)worst_strength(&s, 0.4f));
    assert_true(s.lights_near && s.strengths_unsure && !s.lights_unsure);
    assert_true(mean_angle(&c, &s.normal) < 3);
    assert_true(worst_strength(&s, 0.4f) < 0.15f);
    merlin_surface_free(&s);
    ball_put_away(&c, &e);
}

/* Free strengths explain much, so that they are believed only with a surface that is about what was expected. */
static void strengths_that_contradict_what_is_expected_are_unsure(void **state)
{
    (void)state;
    merlin_capture c;
    ball_expectation e;
    ball_photograph(&c, LIGHTS, lamp, -0.6f, &e); /* a bowl */
    dim_some(&c, 0.4f);
    const pst_expected expected = ball_as_expected(&e);
    const solution found = solve_with(&c, &expected);
    assert_true(found.unequal && found.unsure);
    ball_put_away(&c, &e);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exposures_that_nothing_tells_are_doubted),
        cmocka_unit_test(few_pictures_from_far_away_have_distant_lights),
        cmocka_unit_test(an_expected_surface_decides_what_strengths_do_not),
        cmocka_unit_test(lights_that_nobody_expects_are_unsure),
        cmocka_unit_test(few_pictures_correct_what_is_expected),
        cmocka_unit_test(few_pictures_of_several_objects_are_unsure),
        cmocka_unit_test(strengths_of_near_lights_are_found),
        cmocka_unit_test(strengths_that_contradict_what_is_expected_are_unsure),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
