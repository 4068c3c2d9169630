/* SPDX-License-Identifier: MIT */
/* The light that a network tells, fitted to a photograph by its maps: renderings of a dome under known lights. */
#include "estimate/light/found_light_fit.h"

#include <math.h>
#include <string.h>

#include "estimate/light/found_light.h"
#include "optics/camera.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { SIDE = 84 };

typedef struct scene {
    surface maps;
    img photo, visibility;
    float told[MODEL_LIGHTS]; /* by the network */
} scene;

static float across(int pixel)
{
    return ((float)pixel + 0.5f - SIDE / 2.0f) / (SIDE / 2.0f);
}

/* Makes a patterned sphere that fills the picture from side to side. */
static void make_sphere(surface *s)
{
    assert_int_equal(surface_new(SIDE, SIDE, s), OK);
    for (int i = 0; i < SIDE * SIDE; i++) {
        const float x = across(i % SIDE), y = -across(i / SIDE), z2 = 1 - x * x - y * y;
        if (z2 < 0.1f) continue;
        const float paint = (i / 7 + i / SIDE / 9) % 2 ? 1 : 0.5f;
        vec3_put(vec3_make(x, y, sqrtf(z2)), s->normal.data + 3 * i);
        vec3_put(vec3_scale(vec3_make(0.6f, 0.4f, 0.2f), paint), s->albedo.data + 3 * i);
        s->roughness.data[i] = 0.5f;
        s->depth.data[i] = 1 - 0.4f * sqrtf(z2);
        s->mask.data[i] = 1;
    }
}

static vec3 aside(float degrees, float way)
{
    const float a = degrees * DEGREE, w = way * DEGREE;
    return vec3_make(sinf(a) * cosf(w), sinf(a) * sinf(w), cosf(a));
}

/* Codes a lamp of a strength, a flash, and as much light from everywhere. */
static void put_light(vec3 toward, float inverse, vec3 strength, float flash, float even, float code[MODEL_LIGHTS])
{
    float rest[9][3] = {{even, even, even}};
    vec3_put(toward, code + MODEL_LIGHTS_LAMP);
    code[MODEL_LIGHTS_DISTANCE] = inverse;
    code[MODEL_LIGHTS_STRENGTH] = model_encode_strength(strength.x);
    code[MODEL_LIGHTS_STRENGTH + 1] = model_encode_strength(strength.y);
    code[MODEL_LIGHTS_STRENGTH + 2] = model_encode_strength(strength.z);
    code[MODEL_LIGHTS_FLASH] = model_encode_strength(flash);
    model_encode_sh((const float(*)[3])rest, code + MODEL_LIGHTS_REST);
}

/* Photographs the sphere under a light. */
static void photograph(const float code[MODEL_LIGHTS], scene *s)
{
    merlin_found_light light;
    *s = (scene){.told = {0}};
    make_sphere(&s->maps);
    found_light_take(code, &light);
    assert_int_equal(img_new(&s->photo, SIDE, SIDE, 3), OK);
    assert_int_equal(found_light_add(&s->maps, &light, &s->visibility, &s->photo), OK);
}

static void scene_free(scene *s)
{
    surface_free(&s->maps);
    img_free(&s->photo);
    img_free(&s->visibility);
}

static status fit(scene *s, float white)
{
    return found_light_fit(&(lit_photo){&s->maps, &s->photo, &s->visibility, white}, s->told);
}

static double degrees_between(vec3 a, const float code[MODEL_LIGHTS])
{
    return vec3_angle(a, vec3_of(code + MODEL_LIGHTS_LAMP));
}

/* Returns how far a reconstruction is from the photograph, as a share of the light. */
static double misses(const scene *s, const float code[MODEL_LIGHTS])
{
    img again;
    merlin_found_light light;
    double off = 0, all = 0;
    found_light_take(code, &light);
    assert_int_equal(img_new(&again, SIDE, SIDE, 3), OK);
    assert_int_equal(found_light_add(&s->maps, &light, &s->visibility, &again), OK);
    for (size_t i = 0; i < img_value_count(&again); i++) {
        off += fabs((double)(again.data[i] - s->photo.data[i]));
        all += (double)s->photo.data[i];
    }
    img_free(&again);
    return off / all;
}

static const vec3 warm = {2, 1.6f, 1.2f};

static void a_lamp_told_too_far_aside_is_found(void **state)
{
    (void)state;
    static const float angles[] = {12, 30, 50};
    for (int i = 0; i < 3; i++) {
        float code[MODEL_LIGHTS];
        scene s;
        const vec3 true_way = aside(angles[i], 70);
        put_light(true_way, 1, warm, 0, 0.2f, code);
        photograph(code, &s);
        put_light(vec3_scale(aside(angles[i] + 20, 60), 0.8f), 0.7f, vec3_make(1, 1, 1), 0.5f, 0, s.told);
        assert_int_equal(fit(&s, INFINITY), OK);
        assert_true(degrees_between(true_way, s.told) < 4);
        assert_float_equal(vec3_length(vec3_of(s.told + MODEL_LIGHTS_LAMP)), 0.8f, 1e-4);
        assert_float_equal(s.told[MODEL_LIGHTS_DISTANCE], 1, 0.15);
        scene_free(&s);
    }
}

static void strengths_and_color_are_those_of_the_photograph(void **state)
{
    (void)state;
    const vec3 way = aside(45, 200);
    float code[MODEL_LIGHTS];
    scene s;
    merlin_found_light light;
    put_light(way, 0.8f, warm, 0.3f, 0.4f, code);
    photograph(code, &s);
    put_light(aside(60, 190), 0.8f, vec3_make(1, 1, 1), 0.1f, 0.3f, s.told);
    assert_int_equal(fit(&s, INFINITY), OK);
    found_light_take(s.told, &light);
    assert_float_equal(light.lamp_strength[0] / light.lamp_strength[2], warm.x / warm.z, 0.1);
    assert_true(misses(&s, s.told) < 0.03);
    scene_free(&s);
}

static void burnt_out_pixels_tell_nothing(void **state)
{
    (void)state;
    const vec3 way = aside(30, 0);
    float code[MODEL_LIGHTS];
    scene s;
    put_light(way, 1, warm, 0, 0, code);
    photograph(code, &s);
    const float white = 1.2f;
    size_t burnt = 0;
    for (size_t i = 0; i < img_value_count(&s.photo); i++)
        if (s.photo.data[i] > white) s.photo.data[i] = white, burnt++;
    assert_true(burnt > img_value_count(&s.photo) / 20);
    put_light(aside(50, 10), 0.8f, vec3_make(1, 1, 1), 0, 0, s.told);
    assert_int_equal(fit(&s, white), OK);
    assert_true(degrees_between(way, s.told) < 4);
    scene_free(&s);
}

static void a_lamp_far_aside_stays_where_it_was_told(void **state)
{
    (void)state;
    float code[MODEL_LIGHTS];
    scene s;
    put_light(aside(80, 30), 0.5f, warm, 0, 0.2f, code);
    photograph(code, &s);
    put_light(aside(85, 30), 0.6f, vec3_make(1, 1, 1), 0, 0.2f, s.told);
    assert_int_equal(fit(&s, INFINITY), OK);
    assert_true(degrees_between(aside(85, 30), s.told) < 0.1);
    assert_float_equal(s.told[MODEL_LIGHTS_DISTANCE], 0.6f, 1e-6);
    assert_true(s.told[MODEL_LIGHTS_STRENGTH] > model_encode_strength(1.5f));
    scene_free(&s);
}

static void without_a_lamp_all_light_is_scaled(void **state)
{
    (void)state;
    float code[MODEL_LIGHTS];
    scene s;
    merlin_found_light light;
    put_light(vec3_make(0, 0, 0), 0, vec3_make(0, 0, 0), 0.6f, 0.4f, code);
    photograph(code, &s);
    put_light(vec3_make(0.3f, 0, 0), 1, vec3_make(1, 1, 1), 1.2f, 0.8f, s.told);
    assert_int_equal(fit(&s, INFINITY), OK);
    found_light_take(s.told, &light);
    assert_float_equal(light.flash, 0.6f, 0.03);
    for (int c = 0; c < 3; c++)
        assert_float_equal(light.rest[0][c], 0.4f, 0.02);
    assert_float_equal(s.told[MODEL_LIGHTS_LAMP], 0.3f, 1e-6);
    scene_free(&s);
}

static void a_rooms_coefficients_are_those_of_the_photograph(void **state)
{
    (void)state;
    const float window[9][3] = {{1, 1, 1}, {0.3f, 0.3f, 0.3f}, {0.2f, 0.2f, 0.2f}, {-0.6f, -0.6f, -0.7f}};
    const float told[9][3] = {{0.6f, 0.7f, 0.8f}, {0, 0, 0}, {0.2f, 0.2f, 0.2f}, {0.2f, 0.2f, 0.2f}};
    float code[MODEL_LIGHTS] = {0};
    scene s;
    merlin_found_light light;
    model_encode_sh(window, code + MODEL_LIGHTS_REST);
    photograph(code, &s);
    model_encode_sh(told, s.told + MODEL_LIGHTS_REST);
    const double before = misses(&s, s.told);
    assert_int_equal(fit(&s, INFINITY), OK);
    found_light_take(s.told, &light);
    assert_true(before > 0.3);
    assert_true(misses(&s, s.told) < 0.25 * before);
    assert_true(light.rest[3][0] < -0.3f);
    scene_free(&s);
}

static void nothing_changes_where_nothing_is_told_or_seen(void **state)
{
    (void)state;
    float code[MODEL_LIGHTS], before[MODEL_LIGHTS] = {0};
    scene s;
    put_light(aside(30, 0), 1, warm, 0, 0.2f, code);
    photograph(code, &s);
    assert_int_equal(fit(&s, INFINITY), OK);
    assert_memory_equal(before, s.told, sizeof before);
    put_light(aside(50, 0), 1, vec3_make(1, 1, 1), 0, 0, s.told);
    memcpy(before, s.told, sizeof before);
    assert_int_equal(fit(&s, 1e-4f), OK); /* all is burnt out */
    assert_memory_equal(before, s.told, sizeof before);
    for (size_t i = 0; i < img_value_count(&s.photo); i++)
        s.photo.data[i] = 0;
    assert_int_equal(fit(&s, INFINITY), OK);
    assert_memory_equal(before, s.told, sizeof before);
    scene_free(&s);
}

/* A rest that is no light, and one that hardly reaches what is seen, explain nothing, however often they are taken. */
static void what_is_told_of_the_rest_stays_light(void **state)
{
    (void)state;
    static const float told[2][9] = {{-0.05f, 0, 0.1f}, {0.024f, 0, -0.034f, 0, 0, 0, 0.03f}};
    for (int i = 0; i < 2; i++) {
        float code[MODEL_LIGHTS], rest[9][3];
        scene s;
        merlin_found_light light;
        put_light(aside(45, 90), 0, warm, 0, 0.1f, code);
        photograph(code, &s);
        put_light(vec3_scale(aside(50, 90), 0.9f), 0.3f, vec3_make(1, 1, 1), 0, 0, s.told);
        for (int k = 0; k < 27; k++)
            rest[k / 3][k % 3] = told[i][k / 3];
        model_encode_sh((const float(*)[3])rest, s.told + MODEL_LIGHTS_REST);
        assert_int_equal(fit(&s, INFINITY), OK);
        found_light_take(s.told, &light);
        for (int c = 0; c < 3; c++) {
            assert_true(light.rest[0][c] >= 0 && light.rest[0][c] < 1);
            assert_true(fabsf(light.rest[2][c]) < 1.8f * light.rest[0][c] + 1e-3f);
            assert_true(fabsf(light.rest[6][c]) < 2.3f * light.rest[0][c] + 1e-3f);
        }
        assert_true(misses(&s, s.told) < 0.1);
        scene_free(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_lamp_told_too_far_aside_is_found),
        cmocka_unit_test(strengths_and_color_are_those_of_the_photograph),
        cmocka_unit_test(burnt_out_pixels_tell_nothing),
        cmocka_unit_test(a_lamp_far_aside_stays_where_it_was_told),
        cmocka_unit_test(without_a_lamp_all_light_is_scaled),
        cmocka_unit_test(a_rooms_coefficients_are_those_of_the_photograph),
        cmocka_unit_test(nothing_changes_where_nothing_is_told_or_seen),
        cmocka_unit_test(what_is_told_of_the_rest_stays_light),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
