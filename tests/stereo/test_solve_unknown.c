/* SPDX-License-Identifier: MIT */
/* Lights of unknown strength or direction. */
#include "solve_fixture.h"

/* Strengths of 0.5, 0.75, 1. */
static void weaken_lights(merlin_capture *c)
{
    for (int k = 0; k < c->count; k++)
        for (int i = 0; i < c->width * c->height * c->channels; i++)
            c->picture[k].wide[i] = (uint16_t)((float)c->picture[k].wide[i] * (0.5f + 0.5f * (float)(k % 3) / 2));
    c->intensities_known = false;
}

static void lights_of_unknown_strength_are_found_despite_highlights(void **state)
{
    (void)state;
    merlin_capture c;
    relief_capture(&glossy, &c);
    weaken_lights(&c);
    merlin_surface s;
    assert_int_equal(pst_solve(&c, &(merlin_stereo_params){.method = MERLIN_STEREO_AUTO}, &s), OK);
    assert_int_equal(s.method, MERLIN_STEREO_SEMI);
    assert_false(s.strengths_unsure);
    double angle = mean_angle(&c, &s.normal);
    print_message("semi on the specular relief: %.2f degrees\n", angle);
    assert_true(angle < 3);
    /* strengths of 1, 0.75, 0.5 */
    assert_true(fabsf(s.lights[3].intensity[1] / s.lights[5].intensity[1] - 0.5f) < 0.05f);
    merlin_surface_free(&s);
    /* who asks for this method does not trust what the capture says */
    c.intensities_known = true;
    for (int k = 0; k < c.count; k++)
        c.light[k].intensity[0] = c.light[k].intensity[1] = c.light[k].intensity[2] = 0.3f + (float)(k % 5);
    assert_float_equal(solve_angle(&c, MERLIN_STEREO_SEMI), angle, 1e-3);
    capture_drop(&c);
}

static bool semi_is_unsure(const merlin_capture *c)
{
    merlin_surface s;
    assert_int_equal(pst_solve(c, &(merlin_stereo_params){.method = MERLIN_STEREO_SEMI}, &s), OK);
    bool unsure = s.strengths_unsure;
    print_message("semi on the flat relief: %.2f degrees\n", mean_angle(c, &s.normal));
    merlin_surface_free(&s);
    return unsure;
}

/* Equal strengths explain equal lights at once, and nothing has to be told. */
static void strengths_about_a_flat_object_are_unsure_unless_equal(void **state)
{
    (void)state;
    relief flat = {.size = 48, .lights = 12, .channels = 1, .bump = 0.25f, .specular = 1, .roughness = 0.35f};
    merlin_capture c;
    flat.exposure = 1;
    relief_capture(&flat, &c);
    c.intensities_known = false;
    assert_false(semi_is_unsure(&c));
    weaken_lights(&c);
    assert_true(semi_is_unsure(&c));
    capture_drop(&c);
}

/* Any strengths explain three pictures: the equal ones are no worse, and known to be a guess. */
static void strengths_of_three_lights_are_taken_for_equal(void **state)
{
    (void)state;
    relief r = lambert;
    r.lights = 3;
    merlin_capture c;
    merlin_surface s;
    relief_capture(&r, &c);
    double known = solve_angle(&c, MERLIN_STEREO_ROBUST);
    for (int weak = 0; weak < 2; weak++) {
        assert_int_equal(pst_solve(&c, &(merlin_stereo_params){.method = MERLIN_STEREO_SEMI}, &s), OK);
        assert_true(s.strengths_unsure);
        for (int k = 0; k < 3; k++)
            assert_true(s.lights[k].intensity[0] == 1);
        assert_true(weak || mean_angle(&c, &s.normal) == known);
        merlin_surface_free(&s);
        weaken_lights(&c);
    }
    capture_drop(&c);
}

/* To 5 percent: by so much a light that is 11 percent redder and 6 percent less blue than another is stronger in grey
 * on the white half than on the one without red, and has one strength in grey for both. */
static void colours_of_lights_are_told_from_those_of_the_object(void **state)
{
    (void)state;
    static const float tint[3][3] = {{1, 0.9f, 0.85f}, {0.9f, 0.9f, 0.9f}, {0.85f, 0.9f, 1}};
    merlin_capture c;
    relief_capture(&glossy, &c);
    size_t values = (size_t)c.width * (size_t)c.height * 3;
    for (int k = 0; k < c.count; k++)
        for (size_t i = 0; i < values; i++) {
            /* the left half without red */
            float paint = i % 3 == 0 && i / 3 % (size_t)c.width < (size_t)c.width / 2 ? 0.05f : 1;
            c.picture[k].wide[i] = (uint16_t)((float)c.picture[k].wide[i] * paint * tint[k % 3][i % 3]);
        }
    weaken_lights(&c);
    merlin_surface s;
    assert_int_equal(pst_solve(&c, &(merlin_stereo_params){.method = MERLIN_STEREO_SEMI}, &s), OK);
    const float *base = s.lights[1].intensity; /* white, as every third */
    for (int k = 0; k < c.count; k++)
        for (int ch = 0; ch < 3; ch++) {
            float strength = 0.5f + 0.5f * (float)(k % 3) / 2, wanted = tint[k % 3][ch] / 0.9f * strength / 0.75f;
            assert_float_equal(s.lights[k].intensity[ch] / base[ch], wanted, 0.05f * wanted);
        }
    merlin_surface_free(&s);
    capture_drop(&c);
}

/* As exactly as if it were known. */
static void equal_strengths_are_recognized(void **state)
{
    (void)state;
    merlin_capture c;
    merlin_surface s;
    relief_capture(&glossy, &c);
    double known = solve_angle(&c, MERLIN_STEREO_ROBUST);
    c.intensities_known = false;
    assert_int_equal(pst_solve(&c, &(merlin_stereo_params){.method = MERLIN_STEREO_SEMI}, &s), OK);
    for (int k = 0; k < c.count; k++)
        assert_true(s.lights[k].intensity[0] == 1 && s.lights[k].intensity[2] == 1);
    assert_true(mean_angle(&c, &s.normal) == known);
    merlin_surface_free(&s);
    capture_drop(&c);
}

static void unknown_lights_of_equal_strength_are_found(void **state)
{
    (void)state;
    relief r = lambert;
    r.lights = 30;
    merlin_capture c;
    relief_capture(&r, &c);
    c.lighting = MERLIN_UNKNOWN_LIGHTS;
    double angle = solve_angle(&c, MERLIN_STEREO_AUTO);
    print_message("uncalibrated sphere: %.2f degrees\n", angle);
    assert_true(angle < 3);
    capture_drop(&c);
}

/* Strengths of 0.5 to 1.5. */
static void dim_some(merlin_capture *c)
{
    for (int k = 0; k < c->count; k++)
        for (int i = 0; i < c->width * c->height * c->channels; i++)
            c->picture[k].wide[i] = (uint16_t)((float)c->picture[k].wide[i] * (0.33f + 0.67f * (float)(k * 7 % 5) / 4));
}

/* The sphere's colours as if they were all as bright as its darkest. */
static void even_out(merlin_capture *c)
{
    merlin_surface s;
    assert_int_equal(pst_solve(c, &(merlin_stereo_params){.method = MERLIN_STEREO_LS}, &s), OK);
    for (int i = 0; i < c->width * c->height * c->channels; i++)
        for (int k = 0; k < c->count && s.albedo.data[i] > 0; k++)
            c->picture[k].wide[i] = (uint16_t)((float)c->picture[k].wide[i] * 0.17f / s.albedo.data[i]);
    merlin_surface_free(&s);
}

static void unknown_lights_of_unequal_strength_need_one_albedo(void **state)
{
    (void)state;
    relief r = lambert;
    r.lights = 30;
    for (int even = 0; even < 2; even++) {
        merlin_capture c;
        merlin_surface s;
        relief_capture(&r, &c);
        if (even) even_out(&c);
        dim_some(&c);
        pst_capture_forget_lights(&c);
        c.intensities_known = false;
        if (even) {
            double angle = solve_angle(&c, MERLIN_STEREO_AUTO);
            print_message("uncalibrated sphere of one albedo, unequal lights: %.2f degrees\n", angle);
            assert_true(angle < 3);
        } else {
            assert_int_equal(pst_solve(&c, &(merlin_stereo_params){.method = MERLIN_STEREO_AUTO}, &s),
                             MERLIN_BAD_INPUT);
            assert_non_null(strstr(status_message(), "not equally strong"));
        }
        capture_drop(&c);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lights_of_unknown_strength_are_found_despite_highlights),
        cmocka_unit_test(strengths_about_a_flat_object_are_unsure_unless_equal),
        cmocka_unit_test(strengths_of_three_lights_are_taken_for_equal),
        cmocka_unit_test(colours_of_lights_are_told_from_those_of_the_object),
        cmocka_unit_test(equal_strengths_are_recognized),
        cmocka_unit_test(unknown_lights_of_equal_strength_are_found),
        cmocka_unit_test(unknown_lights_of_unequal_strength_need_one_albedo),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
