/* SPDX-License-Identifier: MIT */
/* Tests what is said of captures whose lights, pictures or places are not what they are taken for, and not of those
 * that are.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "base/status.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

#include "base/rng.h"
#include "image/color.h"
#include "relief.h"
#include "sanitized.h"
#include "stereo/doubts/capture_doubts.h"

enum { SIZE = SANITIZED ? 48 : 72, LIGHTS = 12 };

/* A ball; one with a second bump; a dish, a coin and bumps, which fill the picture. */
typedef enum shape { BALL, PEAR, DISH, COIN, BUMPS } shape;

static float height_of(shape what, float x, float y)
{
    float r = hypotf(x, y), bump = hypotf(x - 14, y - 9), s = 6.2831853f / SIZE;
    switch (what) {
    case BALL:
        return sqrtf(fmaxf(900 - r * r, 0));
    case PEAR:
        return sqrtf(fmaxf(900 - r * r, 0)) + 10 * expf(-bump * bump / 60);
    case DISH:
        return 0.012f * r * r;
    case COIN:
        return 0.6f * sinf(2 * s * x + 0.5f) * cosf(3 * s * y) +
               (r < 20 ? 1.5f : 1.5f * expf(-(r - 20) * (r - 20) / 8));
    default:
        return 5 * (sinf(2 * s * x + 0.5f) * cosf(1.5f * s * y) + 0.5f * sinf(4 * s * y + 0.3f * s * x));
    }
}

static bool is_of(shape what, float x, float y)
{
    float r = hypotf(x, y);
    return what == BALL || what == PEAR ? r < 29 : what == DISH ? r < 33 : true;
}

/* Two rings of lights that are not each other's mirror images. */
static vec3 light_at(int k)
{
    float tilt = k % 3 == 0   ? 0.35f
                 : k % 3 == 1 ? 0.6f
                              : 0.8f,
          phi = 6.2831853f * ((float)k + 0.3f * (float)(k % 4)) / LIGHTS;
    return vec3_make(sinf(tilt) * cosf(phi), sinf(tilt) * sinf(phi), cosf(tilt));
}

static float across(int pixel)
{
    return (float)(pixel % SIZE) + 0.5f - 0.5f * SIZE;
}

static float up(int pixel)
{
    const int row = pixel / SIZE;
    return 0.5f * SIZE - (float)row - 0.5f;
}

static vec3 normal_of(shape what, float x, float y)
{
    const float d = 0.1f;
    return vec3_normalize(vec3_make((height_of(what, x - d, y) - height_of(what, x + d, y)) / (2 * d),
                                    (height_of(what, x, y - d) - height_of(what, x, y + d)) / (2 * d), 1));
}

static void take(shape what, float noise, merlin_capture *c)
{
    rng random = rng_at(7, 0, 0);
    capture_new(c, SIZE, LIGHTS, 1);
    for (int k = 0; k < LIGHTS; k++)
        vec3_put(light_at(k), c->light[k].direction);
    for (int i = 0; i < SIZE * SIZE; i++) {
        const float x = across(i), y = up(i);
        if (!is_of(what, x, y)) continue;
        c->mask.data[i] = 1;
        const vec3 n = normal_of(what, x, y);
        for (int k = 0; k < LIGHTS; k++) {
            float seen =
                0.6f * fmaxf(vec3_dot(n, vec3_of(c->light[k].direction)), 0) + noise * (rng_uniform(&random) - 0.5f);
            c->picture[k].wide[i] = relief_code(fmaxf(seen, 0));
        }
    }
}

/* The warnings of the capture solved by least squares. */
static warnings doubts_of(const merlin_capture *c)
{
    merlin_surface surface;
    warnings doubts = {0};
    assert_int_equal(pst_solve(c, &(merlin_stereo_params){.method = MERLIN_STEREO_LS}, &surface), OK);
    assert_int_equal(pst_doubts(c, &surface, &doubts), OK);
    merlin_surface_free(&surface);
    return doubts;
}

static void assert_told(const merlin_capture *c, const char *code, const char *words)
{
    warnings doubts = doubts_of(c);
    const warning *w = warnings_find(&doubts, code);
    if (!w) fail_msg("no word of %s", code);
    if (!strstr(w->message, words)) fail_msg("\"%s\" is not in \"%s\"", words, w->message);
}

static void assert_silent(const merlin_capture *c)
{
    warnings doubts = doubts_of(c);
    if (doubts.count) fail_msg("%s: %s", doubts.at[0].code, doubts.at[0].message);
}

static void reverse(merlin_capture *c, float x, float y)
{
    for (int k = 0; k < c->count; k++) {
        c->light[k].direction[0] *= x;
        c->light[k].direction[1] *= y;
    }
}

static void lights_that_fit_are_not_doubted(void **state)
{
    (void)state;
    for (shape what = BALL; what <= BUMPS; what++)
        for (int noisy = 0; noisy < 2; noisy++) {
            merlin_capture c;
            take(what, noisy ? 0.02f : 0, &c);
            assert_silent(&c);
            capture_drop(&c);
        }
}

static void reversed_axes_are_named(void **state)
{
    (void)state;
    for (shape what = BALL; what <= PEAR; what++) {
        merlin_capture c;
        take(what, 0.01f, &c);
        reverse(&c, 1, -1);
        assert_told(&c, "lights_do_not_fit", "they fit with y reversed: it points up");
        reverse(&c, -1, -1);
        assert_told(&c, "lights_do_not_fit", "they fit with x reversed: it points to the right");
        reverse(&c, 1, -1);
        assert_told(&c, "lights_do_not_fit", "they fit with x and y reversed, unless the object is a hollow");
        capture_drop(&c);
    }
}

static void without_an_outline_the_curl_tells_of_reversed_axes(void **state)
{
    (void)state;
    merlin_capture c;
    take(BUMPS, 0.01f, &c);
    reverse(&c, 1, -1);
    assert_told(&c, "lights_do_not_fit", "they fit with y (or x) reversed");
    capture_drop(&c);
}

static void exchanged_axes_are_named(void **state)
{
    (void)state;
    merlin_capture c;
    take(PEAR, 0.01f, &c);
    for (int k = 0; k < LIGHTS; k++)
        vec3_put(vec3_make(c.light[k].direction[1], c.light[k].direction[0], c.light[k].direction[2]),
                 c.light[k].direction);
    assert_told(&c, "lights_do_not_fit", "they fit with x and y exchanged");
    for (int k = 0; k < LIGHTS; k++) {
        vec3 l = light_at(k);
        vec3_put(vec3_make(l.x, l.z, -l.y), c.light[k].direction);
    }
    assert_told(&c, "lights_do_not_fit", "x is +x, y -z, z +y of the list");
    capture_drop(&c);
}

/* In the alphabet 10, 11 and 12 stand behind 1. */
static void another_order_is_named(void **state)
{
    (void)state;
    static char names[LIGHTS][24];
    static const int alphabet[LIGHTS] = {0, 9, 10, 11, 1, 2, 3, 4, 5, 6, 7, 8};
    char *name[LIGHTS];
    merlin_capture c;
    take(PEAR, 0.01f, &c);
    for (int k = 0; k < LIGHTS; k++) {
        snprintf(names[k], sizeof names[k], "img_%d.png", k + 1);
        name[k] = names[k];
        vec3_put(light_at(alphabet[k]), c.light[k].direction);
    }
    c.name = name;
    assert_told(&c, "lights_do_not_fit", "they fit in the alphabetical order of the pictures' names");
    reverse(&c, 1, -1);
    assert_told(&c, "lights_do_not_fit", "where 10 stands before 9, and with y reversed");
    c.name = NULL;
    for (int k = 0; k < LIGHTS; k++)
        vec3_put(light_at(LIGHTS - 1 - k), c.light[k].direction);
    assert_told(&c, "lights_do_not_fit", "they fit in reverse order");
    for (int k = 0; k < LIGHTS; k++)
        vec3_put(light_at((k + 1) % LIGHTS), c.light[k].direction);
    assert_told(&c, "lights_do_not_fit", "moved by -1 (light 12 for the first picture)");
    for (int k = 0; k < LIGHTS; k++)
        vec3_put(light_at(k == 2 ? 7 : k == 7 ? 2 : k), c.light[k].direction);
    assert_told(&c, "lights_do_not_fit", "those of pictures 3 and 8 exchanged");
    for (int k = 0; k < LIGHTS; k++)
        vec3_put(light_at(5 * k % 13 % LIGHTS), c.light[k].direction);
    assert_told(&c, "lights_do_not_fit", "is their list in the order");
    capture_drop(&c);
}

static void strengths_that_do_not_fit_are_doubted(void **state)
{
    (void)state;
    merlin_capture c;
    take(PEAR, 0.01f, &c);
    for (int k = 0; k < LIGHTS; k++)
        for (int ch = 0; ch < 3; ch++)
            c.light[k].intensity[ch] = 0.5f + (float)(k * 7 % LIGHTS) / LIGHTS;
    assert_told(&c, "lights_do_not_fit", "they fit as lights of one strength");
    capture_drop(&c);
}

static void a_copied_picture_is_named(void **state)
{
    (void)state;
    merlin_capture c;
    take(PEAR, 0.01f, &c);
    memcpy(c.picture[6].wide, c.picture[4].wide, (size_t)SIZE * SIZE * sizeof(uint16_t));
    assert_told(&c, "same_pictures", "pictures 5 and 7 are the same");
    c.light[6] = c.light[4];
    warnings doubts = doubts_of(&c);
    assert_null(warnings_find(&doubts, "same_pictures"));
    capture_drop(&c);
}

static void burnt_out_pictures_are_told(void **state)
{
    (void)state;
    merlin_capture c;
    take(BALL, 0.01f, &c);
    for (int k = 0; k < LIGHTS; k++)
        for (int i = 0; i < SIZE * SIZE; i++)
            c.picture[k].wide[i] = relief_code(4 * (float)c.picture[k].wide[i] / 65535);
    assert_told(&c, "burnt_out", "take them darker");
    capture_drop(&c);
}

static void lights_from_one_side_or_from_behind_are_told(void **state)
{
    (void)state;
    merlin_capture c;
    take(BALL, 0, &c);
    for (int k = 0; k < LIGHTS; k++) {
        vec3 l = light_at(k);
        vec3_put(vec3_normalize(vec3_make(0.08f * l.x, 0.08f * l.y, l.z)), c.light[k].direction);
    }
    assert_told(&c, "lights_alike", "light the object from more sides");
    for (int k = 0; k < LIGHTS; k++)
        vec3_put(light_at(k), c.light[k].direction);
    c.light[3].direction[2] *= -1;
    assert_told(&c, "lights_behind", "1 of 12 lights stand behind the object");
    capture_drop(&c);
}

static void places_in_another_unit_or_behind_the_camera_are_told(void **state)
{
    (void)state;
    merlin_capture c;
    merlin_surface surface = {.method = MERLIN_STEREO_NEAR};
    warnings doubts = {0};
    take(BALL, 0, &c);
    c.lighting = MERLIN_NEAR_LIGHTS;
    c.camera = pinhole_of(SIZE, SIZE, 30);
    c.camera.distance = 0.6f;        /* metres */
    for (int k = 0; k < LIGHTS; k++) /* millimetres */
        vec3_put(vec3_add(vec3_scale(light_at(k), 400), vec3_make(0, 0, -600)), c.light[k].position);
    assert_int_equal(pst_doubts(&c, &surface, &doubts), OK);
    assert_non_null(warnings_find(&doubts, "other_unit"));
    assert_null(warnings_find(&doubts, "lights_behind_camera"));
    c.camera.distance = 600;
    doubts = (warnings){0};
    assert_int_equal(pst_doubts(&c, &surface, &doubts), OK);
    assert_null(warnings_find(&doubts, "other_unit"));
    for (int k = 0; k < LIGHTS; k++)
        vec3_put(vec3_scale(light_at(k), 400), c.light[k].position);
    assert_int_equal(pst_doubts(&c, &surface, &doubts), OK);
    assert_non_null(warnings_find(&doubts, "lights_behind_camera"));
    capture_drop(&c);
}

static void other_strengths_than_equal_ones_are_told(void **state)
{
    (void)state;
    merlin_capture c;
    take(PEAR, 0, &c);
    for (int k = 0; k < LIGHTS; k++)
        for (int i = 0; i < SIZE * SIZE; i++)
            c.picture[k].wide[i] = (uint16_t)((float)c.picture[k].wide[i] * (0.45f + 0.05f * (float)(7 * k % LIGHTS)));
    assert_told(&c, "strengths_unequal", "light_intensities.txt");
    for (int k = 0; k < LIGHTS; k++)
        for (int ch = 0; ch < 3; ch++)
            c.light[k].intensity[ch] = 0.45f + 0.05f * (float)(7 * k % LIGHTS);
    assert_silent(&c);
    capture_drop(&c);
}

static void dim_a_third(merlin_capture *c, float share)
{
    for (int k = 0; k < LIGHTS; k += 3)
        for (int i = 0; i < SIZE * SIZE; i++)
            c->picture[k].wide[i] = (uint16_t)((float)c->picture[k].wide[i] * share);
}

/* Lights of other strengths are not those of another list, however much they differ. */
static void far_weaker_lights_are_told_from_wrong_ones(void **state)
{
    (void)state;
    for (shape what = BALL; what <= BUMPS; what++)
        for (float share = 0.3f; share < 0.8f; share += 0.2f) {
            merlin_capture c;
            take(what, 0.01f, &c);
            dim_a_third(&c, share);
            assert_told(&c, "strengths_unequal", "light_intensities.txt");
            const warnings doubts = doubts_of(&c);
            assert_null(warnings_find(&doubts, "lights_do_not_fit"));
            capture_drop(&c);
        }
    merlin_capture c;
    take(PEAR, 0.01f, &c);
    dim_a_third(&c, 0.5f);
    reverse(&c, 1, -1);
    assert_told(&c, "strengths_unequal", "light_intensities.txt");
    assert_told(&c, "lights_do_not_fit", "they fit with y reversed: it points up");
    capture_drop(&c);
}

static void change_tones(merlin_capture *c, float (*tone)(float))
{
    for (int k = 0; k < LIGHTS; k++)
        for (int i = 0; i < SIZE * SIZE; i++)
            c->picture[k].wide[i] = (uint16_t)lrintf(65535 * tone((float)c->picture[k].wide[i] / 65535));
}

static void tones_that_were_taken_for_others_are_told(void **state)
{
    (void)state;
    merlin_capture c;
    take(PEAR, 0.01f, &c);
    c.bits = 8;
    assert_silent(&c);
    change_tones(&c, srgb_decode); /* linear values, decoded */
    assert_told(&c, "other_tones", "say so by --linear");
    capture_drop(&c);
    take(PEAR, 0.01f, &c);
    c.bits = 8;
    c.linear = true;
    change_tones(&c, srgb_encode);
    assert_told(&c, "other_tones", "leave it out");
    c.bits = 16;
    c.linear = false;
    assert_told(&c, "other_tones", "which 16 bits are where the file says nothing");
    capture_drop(&c);
}

/* The warnings of the first pictures alone, solved as usual. */
static warnings few_doubts_of(merlin_capture *c, int count)
{
    merlin_surface surface;
    warnings doubts = {0};
    c->count = count;
    assert_int_equal(pst_solve(c, &(merlin_stereo_params){.method = MERLIN_STEREO_ROBUST}, &surface), OK);
    assert_int_equal(pst_doubts(c, &surface, &doubts), OK);
    c->count = LIGHTS;
    merlin_surface_free(&surface);
    return doubts;
}

/* Three pictures have no residual, whatever is wrong with them. */
static void few_pictures_check_nothing_and_it_is_told(void **state)
{
    (void)state;
    merlin_capture c;
    take(BUMPS, 0.01f, &c);
    warnings doubts = few_doubts_of(&c, 3);
    assert_non_null(warnings_find(&doubts, "normals_unchecked"));
    doubts = few_doubts_of(&c, LIGHTS);
    assert_int_equal(doubts.count, 0);
    dim_a_third(&c, 0.5f);
    doubts = few_doubts_of(&c, 4);
    assert_true(warnings_find(&doubts, "strengths_unequal") || warnings_find(&doubts, "normals_unchecked"));
    capture_drop(&c);
}

/* Paints the surface in patches, from nearly black to as bright as before, and adds its varnish's highlight. */
static void add_gloss(shape what, float strength, float sharpness, merlin_capture *c)
{
    for (int i = 0; i < SIZE * SIZE; i++)
        for (int k = 0; k < LIGHTS && c->mask.data[i] > 0; k++) {
            const vec3 half = vec3_normalize(vec3_add(vec3_of(c->light[k].direction), vec3_make(0, 0, 1)));
            const float near = fmaxf(vec3_dot(half, normal_of(what, across(i), up(i))), 0);
            const float paint = 0.55f + 0.45f * sinf(0.25f * across(i)) * sinf(0.2f * up(i));
            const float seen = paint * (float)c->picture[k].wide[i] / 65535 + strength * powf(near, sharpness);
            c->picture[k].wide[i] = relief_code(fminf(seen, 1));
        }
}

/* Highlights look like stronger lights to a fit of three dimensions. */
static void gloss_is_not_taken_for_strengths(void **state)
{
    (void)state;
    merlin_capture c;
    take(COIN, 0.002f, &c);
    add_gloss(COIN, 0.4f, 40, &c);
    const warnings doubts = few_doubts_of(&c, LIGHTS);
    if (doubts.count) fail_msg("%s: %s", doubts.at[0].code, doubts.at[0].message);
    capture_drop(&c);
}

static void an_inverted_mask_is_told(void **state)
{
    (void)state;
    merlin_capture c;
    take(BALL, 0, &c);
    for (int i = 0; i < SIZE * SIZE; i++)
        c.mask.data[i] = 1 - c.mask.data[i];
    merlin_surface none = {.method = MERLIN_STEREO_UNCALIBRATED};
    warnings doubts = {0};
    assert_int_equal(pst_doubts(&c, &none, &doubts), OK);
    assert_non_null(warnings_find(&doubts, "mask_inverted"));
    capture_drop(&c);
}

/* As 8-bit numbers are that a program saved with 16 bits. */
static void dark_pictures_are_solved_unchecked(void **state)
{
    (void)state;
    merlin_capture c;
    take(BALL, 0, &c);
    for (int k = 0; k < LIGHTS; k++)
        for (int i = 0; i < SIZE * SIZE; i++)
            c.picture[k].wide[i] /= 400;
    warnings doubts = doubts_of(&c);
    assert_null(warnings_find(&doubts, "lights_do_not_fit"));
    capture_drop(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lights_that_fit_are_not_doubted),
        cmocka_unit_test(reversed_axes_are_named),
        cmocka_unit_test(without_an_outline_the_curl_tells_of_reversed_axes),
        cmocka_unit_test(exchanged_axes_are_named),
        cmocka_unit_test(another_order_is_named),
        cmocka_unit_test(strengths_that_do_not_fit_are_doubted),
        cmocka_unit_test(a_copied_picture_is_named),
        cmocka_unit_test(burnt_out_pictures_are_told),
        cmocka_unit_test(lights_from_one_side_or_from_behind_are_told),
        cmocka_unit_test(places_in_another_unit_or_behind_the_camera_are_told),
        cmocka_unit_test(other_strengths_than_equal_ones_are_told),
        cmocka_unit_test(far_weaker_lights_are_told_from_wrong_ones),
        cmocka_unit_test(tones_that_were_taken_for_others_are_told),
        cmocka_unit_test(few_pictures_check_nothing_and_it_is_told),
        cmocka_unit_test(gloss_is_not_taken_for_strengths),
        cmocka_unit_test(an_inverted_mask_is_told),
        cmocka_unit_test(dark_pictures_are_solved_unchecked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
