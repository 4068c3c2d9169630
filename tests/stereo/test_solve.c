/* SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

#include <cmocka.h> /* behind ours: it has a macro named fail */

#include "relief.h"
#include "stereo/algebra/matrix3.h"
#include "stereo/fit/pixel_fit.h"
#include "stereo/methods/solve.h"

static const relief lambert = {.size = 48, .lights = 24, .channels = 1, .exposure = 1.8f};
static const relief glossy = {.size = 64,
                              .lights = 50,
                              .channels = 3,
                              .bump = 5,
                              .specular = 4,
                              .roughness = 0.35f,
                              .exposure = 0.3f,
                              .cast_shadows = true};

/* 16 bits leave 1e-4 of a value, 0.01 degrees of its normal. */
static void least_squares_is_exact_on_lambert(void **state)
{
    (void)state;
    for (int channels = 1; channels <= 3; channels += 2) {
        relief r = lambert;
        r.channels = channels;
        pst_capture c;
        relief_capture(&r, &c);
        pst_surface s;
        assert_int_equal(pst_solve(&c, &(pst_options){.method = PST_LS}, &s), OK);
        assert_true(mean_angle(&c, &s.normal) < 0.1);
        size_t middle = 24 * 48 + 24;
        /* x = 0.5 there */
        float expected = 1.8f / BRDF_PI * (0.5f + 0.2f * sinf(0.1f));
        assert_true(fabsf(s.albedo.data[middle * (size_t)channels] - expected) < 1e-3f);
        assert_true(s.residual.data[middle] < 1e-3f);
        pst_surface_free(&s);
        capture_drop(&c);
    }
}

/* Damping keeps a millionth, which rounding to floats may move by a tenth: 6 degrees. */
static void one_light_alone_makes_its_own_direction_the_normal(void **state)
{
    (void)state;
    for (int k = 0; k < 50; k++) {
        vec3 l = relief_light(k, 50), b = vec3_scale(l, 0.7f);
        float m[6] = {0};
        pst_add_outer3(m, l, l);
        assert_true(vec3_length(vec3_sub(pst_solve3(m, b), b)) < 0.1f * 0.7f);
    }
}

/* As much of a ball's rim is under three lights. 8 degrees: as above. */
static void least_squares_turn_what_one_light_reaches_toward_it(void **state)
{
    (void)state;
    relief r = lambert;
    r.lights = 3;
    pst_capture c;
    pst_surface s;
    int checked = 0;
    relief_capture(&r, &c);
    assert_int_equal(pst_solve(&c, &(pst_options){.method = PST_LS}, &s), OK);
    for (int i = 0; i < c.width * c.height; i++) {
        int lit = 0, count = 0;
        for (int k = 0; k < c.count; k++)
            if (c.picture[k][i] > 0) {
                lit = k;
                count++;
            }
        if (count != 1 || c.picture[lit][i] < 2000) continue;
        assert_true(vec3_dot(vec3_of(s.normal.data + 3 * i), c.light[lit].direction) > 0.99f);
        checked++;
    }
    assert_true(checked > 10);
    pst_surface_free(&s);
    capture_drop(&c);
}

static void intensities_are_divided_out(void **state)
{
    (void)state;
    pst_capture c;
    relief_capture(&lambert, &c);
    for (int k = 0; k < c.count; k++) {
        float e = 0.3f + 0.7f * (float)(k % 5) / 4;
        c.light[k].intensity[0] = e;
        for (int i = 0; i < c.width * c.height; i++)
            c.picture[k][i] = (uint16_t)((float)c.picture[k][i] * e + 0.5f);
    }
    assert_true(solve_angle(&c, PST_LS) < 0.1);
    assert_true(solve_angle(&c, PST_ROBUST) < 0.1);
    c.intensities_known = false;
    /* the alternation stops after a fixed number of rounds */
    assert_true(solve_angle(&c, PST_SEMI) < 0.5);
    assert_true(solve_angle(&c, PST_LS) > 2);
    capture_drop(&c);
}

static void intensities_may_be_in_any_unit(void **state)
{
    (void)state;
    pst_capture c;
    relief_capture(&lambert, &c);
    for (float unit = 1e-9f; unit < 1e10f; unit *= 1e6f) {
        for (int k = 0; k < c.count; k++)
            c.light[k].intensity[0] = unit;
        pst_surface s;
        assert_int_equal(pst_solve(&c, &(pst_options){.method = PST_LS}, &s), OK);
        assert_true(mean_angle(&c, &s.normal) < 0.1);
        float expected = 1.8f / BRDF_PI * (0.5f + 0.2f * sinf(0.1f)); /* as above */
        assert_true(fabsf(s.albedo.data[24 * 48 + 24] * unit - expected) < 1e-3f);
        pst_surface_free(&s);
    }
    capture_drop(&c);
}

/* The bar is a public implementation's 3.38 degrees where least squares has 18.47. */
/* One channel ten times as bright as the others, on a black level that no shadow is below. */
static void least_squares_does_not_mind_which_channel_is_bright(void **state)
{
    (void)state;
    double angle[3];
    for (int bright = 0; bright < 3; bright++) {
        relief r = lambert;
        r.channels = 3;
        pst_capture c;
        relief_capture(&r, &c);
        for (int k = 0; k < c.count; k++)
            for (int i = 0; i < c.width * c.height; i++) {
                uint16_t *code = c.picture[k] + 3 * i, grey = code[0];
                for (int ch = 0; ch < 3; ch++)
                    code[ch] = (uint16_t)(80 + (ch == bright ? grey : grey / 10));
            }
        angle[bright] = solve_angle(&c, PST_LS);
        capture_drop(&c);
    }
    assert_float_equal(angle[1], angle[0], 1e-3);
    assert_float_equal(angle[2], angle[0], 1e-3);
}

static void robust_sees_through_highlights_and_cast_shadows(void **state)
{
    (void)state;
    pst_capture c;
    relief_capture(&glossy, &c);
    double ls = solve_angle(&c, PST_LS), robust = solve_angle(&c, PST_ROBUST);
    print_message("specular relief: ls %.2f, robust %.2f degrees\n", ls, robust);
    assert_true(ls > 5);
    assert_true(robust < 2);
    capture_drop(&c);
}

/* Each light's direction off by so many degrees, to this side and that. */
static void miscalibrate(pst_capture *c, float degrees)
{
    for (int k = 0; k < c->count; k++) {
        vec3 l = c->light[k].direction, t1 = vec3_normalize(vec3_make(l.z, 0, -l.x)), t2 = vec3_cross(l, t1);
        float turn = tanf(degrees * 0.01745329f), phi = 3.7f * (float)(k * k + k);
        c->light[k].direction = vec3_normalize(vec3_fma(vec3_fma(l, turn * cosf(phi), t1), turn * sinf(phi), t2));
    }
}

/* What real captures are like: few lights, known to 2 degrees, and a surface that no lobe describes. The margin is for
 * observations that the robust fit does without. */
static void robust_on_few_poor_lights_is_no_worse_than_least_squares(void **state)
{
    (void)state;
    static const float bumps[] = {0, 5};
    for (int count = 12; count <= 16; count += 4)
        for (int i = 0; i < 2; i++) {
            relief r = {.size = 48, .lights = count, .channels = 1, .bump = bumps[i], .facets = 0.3f, .exposure = 1.8f};
            pst_capture c;
            relief_capture(&r, &c);
            miscalibrate(&c, 2);
            double ls = solve_angle(&c, PST_LS), robust = solve_angle(&c, PST_ROBUST);
            print_message("%d lights off by 2 degrees, bumps of %.0f: ls %.2f, robust %.2f degrees\n", count,
                          (double)bumps[i], ls, robust);
            assert_true(robust < 1.02 * ls);
            capture_drop(&c);
        }
}

/* Shadow takes some of few lights from many pixels; what the others leave open, that it is shadow tells. Four lights
 * are too few to tell a strong highlight. */
static void few_lights_are_left_to_robust(void **state)
{
    (void)state;
    for (int count = 3; count <= 7; count++) {
        relief r = glossy;
        r.lights = count;
        if (count <= 4) r.specular = 0.2f;
        pst_capture c;
        relief_capture(&r, &c);
        pst_surface s;
        assert_int_equal(pst_solve(&c, &(pst_options){.method = PST_AUTO}, &s), OK);
        assert_int_equal(s.method, PST_ROBUST);
        double ls = solve_angle(&c, PST_LS), found = mean_angle(&c, &s.normal);
        print_message("%d lights, gloss of %.1f: ls %.2f, auto %.2f degrees\n", count, (double)r.specular, ls, found);
        assert_true(found < ls);
        pst_surface_free(&s);
        capture_drop(&c);
    }
}

static void a_raised_black_level_is_found(void **state)
{
    (void)state;
    pst_capture c;
    relief_capture(&lambert, &c);
    for (int k = 0; k < c.count; k++)
        for (int i = 0; i < c.width * c.height; i++)
            c.picture[k][i] = c.picture[k][i] > 2000 ? (uint16_t)(c.picture[k][i] - 2000) : 0;
    assert_true(solve_angle(&c, PST_ROBUST) < 0.7 * solve_angle(&c, PST_LS));
    capture_drop(&c);
}

/* Strengths of 0.5, 0.75, 1. */
static void weaken_lights(pst_capture *c)
{
    for (int k = 0; k < c->count; k++)
        for (int i = 0; i < c->width * c->height * c->channels; i++)
            c->picture[k][i] = (uint16_t)((float)c->picture[k][i] * (0.5f + 0.5f * (float)(k % 3) / 2));
    c->intensities_known = false;
}

static void lights_of_unknown_strength_are_found_despite_highlights(void **state)
{
    (void)state;
    pst_capture c;
    relief_capture(&glossy, &c);
    weaken_lights(&c);
    pst_surface s;
    assert_int_equal(pst_solve(&c, &(pst_options){.method = PST_AUTO}, &s), OK);
    assert_int_equal(s.method, PST_SEMI);
    assert_false(s.strengths_unsure);
    double angle = mean_angle(&c, &s.normal);
    print_message("semi on the specular relief: %.2f degrees\n", angle);
    assert_true(angle < 3);
    /* strengths of 1, 0.75, 0.5 */
    assert_true(fabsf(s.light[3].intensity[1] / s.light[5].intensity[1] - 0.5f) < 0.05f);
    pst_surface_free(&s);
    /* who asks for this method does not trust what the capture says */
    c.intensities_known = true;
    for (int k = 0; k < c.count; k++)
        c.light[k].intensity[0] = c.light[k].intensity[1] = c.light[k].intensity[2] = 0.3f + (float)(k % 5);
    assert_float_equal(solve_angle(&c, PST_SEMI), angle, 1e-3);
    capture_drop(&c);
}

static bool semi_is_unsure(const pst_capture *c)
{
    pst_surface s;
    assert_int_equal(pst_solve(c, &(pst_options){.method = PST_SEMI}, &s), OK);
    bool unsure = s.strengths_unsure;
    print_message("semi on the flat relief: %.2f degrees\n", mean_angle(c, &s.normal));
    pst_surface_free(&s);
    return unsure;
}

/* Equal strengths explain equal lights at once, and nothing has to be told. */
static void strengths_about_a_flat_object_are_unsure_unless_equal(void **state)
{
    (void)state;
    relief flat = {.size = 48, .lights = 12, .channels = 1, .bump = 0.25f, .specular = 1, .roughness = 0.35f};
    pst_capture c;
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
    pst_capture c;
    pst_surface s;
    relief_capture(&r, &c);
    double known = solve_angle(&c, PST_ROBUST);
    for (int weak = 0; weak < 2; weak++) {
        assert_int_equal(pst_solve(&c, &(pst_options){.method = PST_SEMI}, &s), OK);
        assert_true(s.strengths_unsure);
        for (int k = 0; k < 3; k++)
            assert_true(s.light[k].intensity[0] == 1);
        assert_true(weak || mean_angle(&c, &s.normal) == known);
        pst_surface_free(&s);
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
    pst_capture c;
    relief_capture(&glossy, &c);
    size_t values = (size_t)c.width * (size_t)c.height * 3;
    for (int k = 0; k < c.count; k++)
        for (size_t i = 0; i < values; i++) {
            /* the left half without red */
            float paint = i % 3 == 0 && i / 3 % (size_t)c.width < (size_t)c.width / 2 ? 0.05f : 1;
            c.picture[k][i] = (uint16_t)((float)c.picture[k][i] * paint * tint[k % 3][i % 3]);
        }
    weaken_lights(&c);
    pst_surface s;
    assert_int_equal(pst_solve(&c, &(pst_options){.method = PST_SEMI}, &s), OK);
    const float *base = s.light[1].intensity; /* white, as every third */
    for (int k = 0; k < c.count; k++)
        for (int ch = 0; ch < 3; ch++) {
            float strength = 0.5f + 0.5f * (float)(k % 3) / 2, wanted = tint[k % 3][ch] / 0.9f * strength / 0.75f;
            assert_float_equal(s.light[k].intensity[ch] / base[ch], wanted, 0.05f * wanted);
        }
    pst_surface_free(&s);
    capture_drop(&c);
}

/* As exactly as if it were known. */
static void equal_strengths_are_recognized(void **state)
{
    (void)state;
    pst_capture c;
    pst_surface s;
    relief_capture(&glossy, &c);
    double known = solve_angle(&c, PST_ROBUST);
    c.intensities_known = false;
    assert_int_equal(pst_solve(&c, &(pst_options){.method = PST_SEMI}, &s), OK);
    for (int k = 0; k < c.count; k++)
        assert_true(s.light[k].intensity[0] == 1 && s.light[k].intensity[2] == 1);
    assert_true(mean_angle(&c, &s.normal) == known);
    pst_surface_free(&s);
    capture_drop(&c);
}

static void unknown_lights_of_equal_strength_are_found(void **state)
{
    (void)state;
    relief r = lambert;
    r.lights = 30;
    pst_capture c;
    relief_capture(&r, &c);
    c.lighting = PST_UNKNOWN_LIGHT;
    double angle = solve_angle(&c, PST_AUTO);
    print_message("uncalibrated sphere: %.2f degrees\n", angle);
    assert_true(angle < 3);
    capture_drop(&c);
}

/* Strengths of 0.5 to 1.5. */
static void dim_some(pst_capture *c)
{
    for (int k = 0; k < c->count; k++)
        for (int i = 0; i < c->width * c->height * c->channels; i++)
            c->picture[k][i] = (uint16_t)((float)c->picture[k][i] * (0.33f + 0.67f * (float)(k * 7 % 5) / 4));
}

/* The sphere's colours as if they were all as bright as its darkest. */
static void even_out(pst_capture *c)
{
    pst_surface s;
    assert_int_equal(pst_solve(c, &(pst_options){.method = PST_LS}, &s), OK);
    for (int i = 0; i < c->width * c->height * c->channels; i++)
        for (int k = 0; k < c->count && s.albedo.data[i] > 0; k++)
            c->picture[k][i] = (uint16_t)((float)c->picture[k][i] * 0.17f / s.albedo.data[i]);
    pst_surface_free(&s);
}

static void unknown_lights_of_unequal_strength_need_one_albedo(void **state)
{
    (void)state;
    relief r = lambert;
    r.lights = 30;
    for (int even = 0; even < 2; even++) {
        pst_capture c;
        pst_surface s;
        relief_capture(&r, &c);
        if (even) even_out(&c);
        dim_some(&c);
        pst_capture_forget_lights(&c);
        c.intensities_known = false;
        if (even) {
            double angle = solve_angle(&c, PST_AUTO);
            print_message("uncalibrated sphere of one albedo, unequal lights: %.2f degrees\n", angle);
            assert_true(angle < 3);
        } else {
            assert_int_equal(pst_solve(&c, &(pst_options){.method = PST_AUTO}, &s), MERLIN_BAD_INPUT);
            assert_non_null(strstr(status_message(), "not equally strong"));
        }
        capture_drop(&c);
    }
}

static void all_values_are_numbers(const pst_surface *s)
{
    size_t pixels = (size_t)s->normal.width * (size_t)s->normal.height;
    for (size_t i = 0; i < pixels; i++) {
        const float *n = s->normal.data + 3 * i;
        float length = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
        assert_true(length == 0 || (fabsf(length - 1) < 1e-3f && n[2] > 0));
        assert_true(isfinite(s->residual.data[i]));
        for (size_t ch = 0; ch < (size_t)s->albedo.channels; ch++)
            assert_true(isfinite(s->albedo.data[i * (size_t)s->albedo.channels + ch]));
    }
}

static void darkness_and_saturation_leave_numbers(void **state)
{
    (void)state;
    static const pst_method method[] = {PST_LS, PST_ROBUST, PST_SEMI};
    for (int code = 0; code <= 65535; code += 65535) {
        pst_capture c;
        relief_capture(&lambert, &c);
        for (int k = 0; k < c.count; k++)
            for (int i = 0; i < c.width * c.height; i++)
                c.picture[k][i] = (uint16_t)code;
        for (size_t m = 0; m < sizeof method / sizeof *method; m++) {
            pst_surface s;
            if (pst_solve(&c, &(pst_options){.method = method[m]}, &s) != OK) continue;
            all_values_are_numbers(&s);
            pst_surface_free(&s);
        }
        capture_drop(&c);
    }
}

static void refused(const pst_capture *c, pst_method method, const char *because)
{
    pst_surface s;
    assert_true(pst_solve(c, &(pst_options){.method = method}, &s) != OK);
    assert_non_null(strstr(status_message(), because));
    assert_null(s.normal.data);
}

static void impossible_captures_are_refused_in_one_line(void **state)
{
    (void)state;
    pst_capture c;
    relief_capture(&lambert, &c);
    refused(&c, PST_NEAR_LIGHTS, "positions");
    int count = c.count;
    c.count = 2;
    refused(&c, PST_LS, "3 or more");
    c.count = PST_MAX_LIGHTS + 1;
    refused(&c, PST_ROBUST, "1025 pictures");
    c.lighting = PST_UNKNOWN_LIGHT;
    refused(&c, PST_UNCALIBRATED, "1025 pictures");
    c.lighting = PST_DISTANT;
    c.count = count;
    float kept = c.light[3].intensity[0];
    c.light[3].intensity[0] = -1;
    refused(&c, PST_ROBUST, "light 4");
    c.light[3].intensity[0] = kept;
    for (int k = 0; k < c.count; k++)
        c.light[k].direction.z *= -1;
    refused(&c, PST_ROBUST, "z of a direction to a light points toward the camera");
    for (int k = 0; k < c.count; k++)
        c.light[k].direction = vec3_normalize(vec3_make((float)k, 0, 5));
    refused(&c, PST_ROBUST, "one plane");
    c.lighting = PST_UNKNOWN_LIGHT;
    refused(&c, PST_LS, "light directions");
    memset(c.mask.data, 0, (size_t)c.width * (size_t)c.height * sizeof(float));
    refused(&c, PST_UNCALIBRATED, "mask is empty");
    capture_drop(&c);
}

static void one_black_picture_of_few_is_refused(void **state)
{
    (void)state;
    for (int count = 4; count <= 8; count += 4) {
        relief r = lambert;
        r.lights = count;
        pst_capture c;
        relief_capture(&r, &c);
        for (int i = 0; i < c.width * c.height * c.channels; i++)
            c.picture[2][i] = (uint16_t)(i * 7 % 200); /* noise */
        if (count < 8) {
            refused(&c, PST_LS, "picture 3");
            refused(&c, PST_AUTO, "is black");
        } else {
            assert_true(solve_angle(&c, PST_AUTO) < 1);
        }
        capture_drop(&c);
    }
}

static void methods_are_named(void **state)
{
    (void)state;
    for (int m = PST_AUTO; m <= PST_UNCALIBRATED; m++)
        assert_int_equal(pst_method_from_name(pst_method_name((pst_method)m)), m);
    assert_int_equal(pst_method_from_name("magic"), -1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(least_squares_is_exact_on_lambert),
        cmocka_unit_test(one_light_alone_makes_its_own_direction_the_normal),
        cmocka_unit_test(least_squares_turn_what_one_light_reaches_toward_it),
        cmocka_unit_test(intensities_are_divided_out),
        cmocka_unit_test(intensities_may_be_in_any_unit),
        cmocka_unit_test(least_squares_does_not_mind_which_channel_is_bright),
        cmocka_unit_test(robust_sees_through_highlights_and_cast_shadows),
        cmocka_unit_test(robust_on_few_poor_lights_is_no_worse_than_least_squares),
        cmocka_unit_test(few_lights_are_left_to_robust),
        cmocka_unit_test(a_raised_black_level_is_found),
        cmocka_unit_test(lights_of_unknown_strength_are_found_despite_highlights),
        cmocka_unit_test(strengths_about_a_flat_object_are_unsure_unless_equal),
        cmocka_unit_test(strengths_of_three_lights_are_taken_for_equal),
        cmocka_unit_test(colours_of_lights_are_told_from_those_of_the_object),
        cmocka_unit_test(equal_strengths_are_recognized),
        cmocka_unit_test(unknown_lights_of_equal_strength_are_found),
        cmocka_unit_test(unknown_lights_of_unequal_strength_need_one_albedo),
        cmocka_unit_test(darkness_and_saturation_leave_numbers),
        cmocka_unit_test(impossible_captures_are_refused_in_one_line),
        cmocka_unit_test(one_black_picture_of_few_is_refused),
        cmocka_unit_test(methods_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
