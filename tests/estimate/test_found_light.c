/* SPDX-License-Identifier: MIT */
/* The light that a model of any light sees: from its code to a lamp, and a surface under it. */
#include "estimate/light/found_light.h"

#include <math.h>
#include <string.h>

#include "optics/camera.h"
#include "optics/sh.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { SIDE = 24 };

static void make_bowl(surface *s)
{
    assert_int_equal(surface_new(SIDE, SIDE, s), OK);
    for (int i = 0; i < SIDE * SIDE; i++) {
        float x = ((float)(i % SIDE) - 11.5f) / 14, y = ((float)(i / SIDE) - 11.5f) / 14;
        vec3_put(vec3_normalize(vec3_make(x, -y, 1)), s->normal.data + 3 * i);
        vec3_put(vec3_make(0.6f, 0.4f, 0.2f), s->albedo.data + 3 * i);
        s->roughness.data[i] = 0.5f;
        s->depth.data[i] = 1 + 0.1f * (x * x + y * y);
        s->mask.data[i] = 1;
    }
}

static void expect_near(const img *a, const img *b, float scale)
{
    for (size_t i = 0; i < img_value_count(a); i++)
        assert_float_equal(a->data[i], scale * b->data[i], 1e-4f + 1e-3f * fabsf(a->data[i]));
}

static void a_near_lamp_is_where_the_code_says_and_as_strong_in_the_middle(void **state)
{
    (void)state;
    const vec3 at = {0.6f, 0.3f, -0.2f}, way = {0.6f, 0.3f, 0.8f};
    const float far = vec3_length(way), none[MODEL_LIGHTS] = {0};
    float code[MODEL_LIGHTS];
    surface s;
    img lit, plain, nothing = {0};
    merlin_found_light light;
    make_bowl(&s);
    memcpy(code, none, sizeof code);
    vec3_put(vec3_scale(way, 0.9f / far), code + MODEL_LIGHTS_LAMP);
    code[MODEL_LIGHTS_DISTANCE] = 1 / far;
    for (int c = 0; c < 3; c++)
        code[MODEL_LIGHTS_STRENGTH + c] = model_encode_strength(2);
    found_light_take(code, &light);
    assert_float_equal(light.lamp_sure, 0.9f, 1e-5);
    assert_float_equal(light.lamp_distance, far, 1e-4);
    assert_int_equal(img_new(&lit, SIDE, SIDE, 3), OK);
    assert_int_equal(found_light_add(&s, &light, &nothing, &lit), OK);
    assert_int_equal(surface_shade(&s, at, &plain), OK);
    expect_near(&lit, &plain, 2 * far * far);
    img_free(&lit);
    img_free(&plain);
    surface_free(&s);
}

static void what_the_model_is_hardly_sure_of_is_no_lamp(void **state)
{
    (void)state;
    float code[MODEL_LIGHTS] = {[MODEL_LIGHTS_LAMP] = 0.3f, [MODEL_LIGHTS_STRENGTH] = 1};
    merlin_found_light light;
    lamp l;
    found_light_take(code, &light);
    assert_float_equal(light.lamp_sure, 0.3f, 1e-6);
    assert_false(found_light_lamp(&light, &l));
    assert_true(light.lamp_strength[0] == 0);
}

static void flash_and_rest_add_up(void **state)
{
    (void)state;
    float code[MODEL_LIGHTS] = {0}, sh[9][3] = {{1, 1, 1}, {0.1f, 0.1f, 0.1f}, {0.3f, 0.3f, 0.3f}};
    surface s;
    img lit, flash, nothing = {0};
    merlin_found_light light;
    make_bowl(&s);
    s.matte = true;
    code[MODEL_LIGHTS_FLASH] = model_encode_strength(0.5f);
    model_encode_sh((const float(*)[3])sh, code + MODEL_LIGHTS_REST);
    found_light_take(code, &light);
    assert_float_equal(light.flash, 0.5f, 1e-5);
    assert_int_equal(img_new(&lit, SIDE, SIDE, 3), OK);
    assert_int_equal(found_light_add(&s, &light, &nothing, &lit), OK);
    assert_int_equal(surface_shade(&s, vec3_make(0, 0, 0), &flash), OK);
    for (size_t i = 0; i < 3 * SIDE * SIDE; i += 97) {
        vec3 n = vec3_of(s.normal.data + i / 3 * 3);
        float ambient = s.albedo.data[i] / PI * sh_irradiance((const float(*)[3])sh, n).x;
        /* highlights of the surroundings come on top */
        assert_true(lit.data[i] >= 0.5f * flash.data[i] + ambient - 1e-4f);
        assert_true(lit.data[i] <= 0.5f * flash.data[i] + ambient + 0.1f);
    }
    img_free(&lit);
    img_free(&flash);
    surface_free(&s);
}

static void what_hides_the_lamp_takes_its_light(void **state)
{
    (void)state;
    float code[MODEL_LIGHTS] = {[MODEL_LIGHTS_LAMP + 2] = 1};
    surface s;
    img lit, hidden;
    merlin_found_light light;
    make_bowl(&s);
    for (int c = 0; c < 3; c++)
        code[MODEL_LIGHTS_STRENGTH + c] = model_encode_strength(1);
    found_light_take(code, &light);
    assert_true(light.lamp_distance == 0);
    assert_int_equal(img_new(&hidden, SIDE, SIDE, 1), OK);
    assert_int_equal(img_new(&lit, SIDE, SIDE, 3), OK);
    assert_int_equal(found_light_add(&s, &light, &hidden, &lit), OK);
    for (size_t i = 0; i < img_value_count(&lit); i++)
        assert_true(lit.data[i] == 0);
    img_free(&lit);
    img_free(&hidden);
    surface_free(&s);
}

/* Far away, so far aside and so far up from the right, in degrees. */
static merlin_found_light lamp_from(float aside, float turn, float strength, float flash)
{
    const float a = aside * DEGREE, t = turn * DEGREE;
    return (merlin_found_light){.known = 1,
                                .flash = flash,
                                .lamp = {sinf(a) * cosf(t), sinf(a) * sinf(t), cosf(a)},
                                .lamp_sure = 1,
                                .lamp_strength = {strength, strength, strength}};
}

static void a_light_turned_by_steps_stands_as_one_turned_at_once(void **state)
{
    (void)state;
    merlin_found_light light = lamp_from(40, 20, 1, 0.5f);
    const float rounding = 1e-6f; /* of a few sums of values about 1 */
    found_lights at_once, by_steps;
    light.lamp_distance = 2;
    light.rest[0][0] = light.rest[3][0] = 1;
    assert_int_equal(found_light_stand(&light, 70, &at_once), OK);
    assert_int_equal(found_light_stand(&light, 50, &by_steps), OK);
    found_lights_turn(&by_steps, 15);
    found_lights_turn(&by_steps, 5);
    assert_int_equal(by_steps.count, 2);
    for (int i = 0; i < 2; i++)
        assert_true(vec3_length(vec3_sub(by_steps.lamps[i].at, at_once.lamps[i].at)) < rounding);
    assert_true(vec3_length(by_steps.lamps[0].at) == 0); /* the flash stays at the lens */
    for (int k = 0; k < 9; k++)
        assert_true(fabsf(by_steps.rest.sh[k][0] - at_once.rest.sh[k][0]) < rounding);
    env_map_free(&at_once.rest);
    env_map_free(&by_steps.rest);
}

static void light_has_words(void **state)
{
    (void)state;
    char words[MERLIN_LIGHT_WORDS];
    merlin_found_light light = lamp_from(40, 135, 1, 0);
    merlin_light_words(&light, words, sizeof words);
    assert_string_equal(words, "a lamp from the upper left, 40 degrees aside");
    light = lamp_from(100, -90, 1, 1);
    merlin_light_words(&light, words, sizeof words);
    assert_string_equal(words, "a flash and a lamp from below, 100 degrees aside");
    light = lamp_from(60, 10, 1, 0.1f);
    light.rest[0][0] = light.rest[0][1] = light.rest[0][2] = 3;
    merlin_light_words(&light, words, sizeof words);
    assert_string_equal(words, "a lamp from the right, 60 degrees aside, in a room");
    light = lamp_from(2, 10, 1, 0);
    merlin_light_words(&light, words, sizeof words);
    assert_string_equal(words, "a lamp by the lens");
    light = (merlin_found_light){.known = 1, .rest = {{1, 1, 1}}};
    merlin_light_words(&light, words, sizeof words);
    assert_string_equal(words, "a room's light");
    light = (merlin_found_light){.known = 1, .flash = 1};
    merlin_light_words(&light, words, sizeof words);
    assert_string_equal(words, "a flash");
    light.rest[0][0] = light.rest[0][1] = light.rest[0][2] = 0.6f; /* a twelfth of all */
    merlin_light_words(&light, words, sizeof words);
    assert_string_equal(words, "a flash and a little other light");
    light = (merlin_found_light){.known = 1, .rest = {{-1, -1, -1}}};
    merlin_light_words(&light, words, sizeof words);
    assert_string_equal(words, "light of an unknown kind");
    merlin_light_words(&(merlin_found_light){0}, words, sizeof words);
    assert_string_equal(words, "");
}

/* Black in place of what is negative adds no light. */
static void the_rests_picture_has_the_power_of_its_coefficients(void **state)
{
    (void)state;
    merlin_found_light light = {.known = 1};
    for (int c = 0; c < 3; c++) {
        light.rest[0][c] = 1 + (float)c;
        light.rest[2][c] = light.rest[6][c] = 1.5f; /* negative behind */
    }
    found_lights lights;
    assert_int_equal(found_light_stand(&light, 0, &lights), OK);
    for (int c = 0; c < 3; c++)
        assert_float_equal(found_lights_rest(&lights)->sh[0][c], light.rest[0][c], 1e-3 * (double)light.rest[0][c]);
    env_map_free(&lights.rest);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_near_lamp_is_where_the_code_says_and_as_strong_in_the_middle),
        cmocka_unit_test(what_the_model_is_hardly_sure_of_is_no_lamp),
        cmocka_unit_test(flash_and_rest_add_up),
        cmocka_unit_test(what_hides_the_lamp_takes_its_light),
        cmocka_unit_test(a_light_turned_by_steps_stands_as_one_turned_at_once),
        cmocka_unit_test(light_has_words),
        cmocka_unit_test(the_rests_picture_has_the_power_of_its_coefficients),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
