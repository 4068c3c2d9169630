/* SPDX-License-Identifier: MIT */
/* The network of near lights: its inputs as numbers, its stages, its configuration. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/rng.h"
#include "compiled.h"
#include "model/model.h"
#include "model/nfps/nfps.h"
#include "model/nfps/nfps_inputs.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { SIDE = 8, PIXELS = SIDE * SIDE, PICTURES = 3 };

static void near(vec3 a, vec3 b, double tolerance)
{
    assert_true((double)vec3_length(vec3_sub(a, b)) <= tolerance);
}

static void a_turn_takes_the_view_to_the_front_and_back(void **state)
{
    (void)state;
    rng r = rng_at(1, 2, 3);
    for (int i = 0; i < 100; i++) {
        const vec3 view = vec3_normalize(vec3_make(rng_normal(&r), rng_normal(&r), fabsf(rng_normal(&r)) + 0.2f));
        const vec3 v = vec3_make(rng_normal(&r), rng_normal(&r), rng_normal(&r));
        near(nfps_turn(view, view), vec3_make(0, 0, 1), 1e-6);
        near(nfps_turn_back(view, nfps_turn(view, v)), v, 1e-5);
        assert_true(fabsf(vec3_dot(nfps_turn(view, v), vec3_make(0, 0, 1)) - vec3_dot(v, view)) < 1e-5f);
    }
}

static void a_light_falls_off_with_distance_and_lobe(void **state)
{
    (void)state;
    float strength;
    const nfps_light point = {.at = {0, 0, 0}}, led = {.at = {0, 0, 0}, .axis = {0, 0, -1}, .lobe = 2};
    near(nfps_light_at(&point, vec3_make(0, 0, -2), &strength), vec3_make(0, 0, 1), 1e-6);
    assert_true(fabsf(strength - 0.25f) < 1e-6f);
    nfps_light_at(&led, vec3_make(2, 0, -2), &strength);
    assert_true(fabsf(strength - 0.5f / 8) < 1e-6f); /* cos² of 45 degrees over the squared distance */
    const nfps_light sun = {.at = {0, 0.6f, 0.8f}, .distant = true};
    near(nfps_light_at(&sun, vec3_make(2, 0, -2), &strength), vec3_make(0, 0.6f, 0.8f), 1e-6);
    assert_true(strength == 1);
}

/* A matte plane seen through a lens of 60 degrees, lit by three lights. */
typedef struct plane {
    float mask[PIXELS], point[3 * PIXELS], view[3 * PIXELS], images[3 * PICTURES * PIXELS];
    float work[PICTURES * PIXELS], picture[NFPS_PICTURE * PICTURES * PIXELS], light[NFPS_LIGHT * PICTURES * PIXELS];
    nfps_light lights[PICTURES];
    nfps_scene scene;
} plane;

static void plane_of(plane *p, float albedo_right)
{
    static const vec3 places[PICTURES] = {{0, 0, 0}, {0.5f, 0, -0.1f}, {0, -0.6f, 0.1f}};
    for (int i = 0; i < PIXELS; i++) {
        const float x = ((float)(i % SIDE) + 0.5f) / SIDE - 0.5f, y = 0.5f - ((float)(i / SIDE) + 0.5f) / SIDE;
        const vec3 ray = vec3_make(1.1547f * x, 1.1547f * y, -1);
        p->mask[i] = i % SIDE > 0;
        vec3_put(ray, p->point + 3 * i);
        vec3_put(vec3_scale(vec3_normalize(ray), -1), p->view + 3 * i);
        for (int k = 0; k < PICTURES; k++) {
            float strength;
            p->lights[k] = (nfps_light){.at = places[k]};
            const vec3 l = nfps_light_at(&p->lights[k], ray, &strength);
            for (int c = 0; c < 3; c++)
                p->images[3 * (k * PIXELS + i) + c] = (x > 0 ? albedo_right : 0.4f) * strength * l.z;
        }
    }
    p->scene = (nfps_scene){PIXELS, PICTURES, p->mask, p->point, p->view, p->lights, false};
    nfps_encode(&p->scene, p->images, p->work, p->picture, p->light);
}

static void inputs_are_light_without_fall_off(void **state)
{
    (void)state;
    static plane p;
    plane_of(&p, 0.4f);
    /* all channels squared are proportional to the cosine, the same factor everywhere */
    float factor = 0;
    for (int k = 0; k < PICTURES; k++)
        for (int i = 0; i < PIXELS; i++) {
            const float *picture = p.picture + NFPS_PICTURE * (k * PIXELS + i);
            const float *light = p.light + NFPS_LIGHT * (k * PIXELS + i);
            if (!(p.mask[i] > 0.5f)) {
                for (int c = 0; c < NFPS_PICTURE; c++)
                    assert_true(picture[c] == 0);
                for (int c = 0; c < NFPS_LIGHT; c++)
                    assert_true(light[c] == 0);
                continue;
            }
            const vec3 l = nfps_turn_back(vec3_of(p.view + 3 * i), vec3_of(light));
            if (factor == 0) factor = picture[0] * picture[0] / l.z;
            assert_true(fabsf(picture[0] * picture[0] - factor * l.z) < 1e-4f * factor);
            assert_true(light[4] == 0);
        }
}

static void a_pixels_share_does_without_its_albedo(void **state)
{
    (void)state;
    static plane same, other;
    plane_of(&same, 0.4f);
    plane_of(&other, 0.8f);
    for (int i = 0; i < PICTURES * PIXELS; i++) /* DARK's share differs a little with the mean */
        assert_true(fabsf(same.picture[NFPS_PICTURE * i + 3] - other.picture[NFPS_PICTURE * i + 3]) < 0.03f);
}

static const model_config tiny = {.name = "tiny", .nfps_width = 8};

static nn_program *compile(model_part part, nn_purpose purpose, nn_params **params)
{
    nn_graph *g = NULL;
    nn_program *p = NULL;
    const nn_options options = {
        .batch = 6, .group = 3, .height = 16, .width = 16, .type = NN_FLOAT32, .purpose = purpose};
    status s = model_build(&tiny, part, &g);
    if (s == OK && !*params) s = nn_params_new(g, 7, params);
    if (s == OK) s = nn_compile(g, *params, &options, &p);
    nn_graph_free(g);
    if (s != OK) fail_msg("%s", status_message());
    return p;
}

static void fill(nn_program *p, const char *name, size_t count, float low)
{
    rng r = rng_at(5, count, 0);
    float *data = nn_input_data(p, name);
    for (size_t i = 0; data && i < count; i++)
        data[i] = rng_range(&r, low, 1);
}

static void fill_all(nn_program *p, const char *prefix, size_t pixels)
{
    static const struct {
        const char *name;
        size_t values;
        float low;
    } inputs[] = {{"picture", 6 * NFPS_PICTURE, 0},
                  {"light", 6 * NFPS_LIGHT, -1},
                  {"mask", 2, 1},
                  {"normal", 2 * 3, -1},
                  {"normal_true", 2 * 3, -1},
                  {"loss_mask", 2, 1}};
    char name[32];
    for (size_t i = 0; i < sizeof inputs / sizeof *inputs; i++) {
        snprintf(name, sizeof name, "%s%s", prefix, inputs[i].name);
        fill(p, name, inputs[i].values * pixels, inputs[i].low);
    }
}

static void stages_learn_by_themselves(void **state)
{
    (void)state;
    nn_params *params = NULL;
    nn_program *p = compile(MODEL_TRAINING, NN_TRAIN, &params);
    fill_all(p, "", 256);
    fill_all(p, "first_", 64);
    static const char *const losses[] = {"first_normal", "normal"}, *const own[] = {"first.", "refine."};
    for (int i = 0; i < 2; i++) {
        nn_set_loss_weight(p, losses[i], 1);
        nn_set_loss_weight(p, losses[1 - i], 0);
        assert_int_equal(nn_forward(p), OK);
        assert_int_equal(nn_backward(p), OK);
        assert_true(isfinite(nn_total_loss(p)));
        assert_true(size_of_gradients(params, own[i]) > 0);
        assert_true(size_of_gradients(params, own[1 - i]) == 0);
    }
    nn_program_free(p);
    nn_params_free(params);
}

/* The stages alone, as they are used, are those of the whole network. */
static void stages_alone_give_the_wholes_normals(void **state)
{
    (void)state;
    nn_params *params = NULL;
    nn_program *whole = compile(MODEL_WHOLE, NN_INFER, &params), *alone = compile(MODEL_REFINE, NN_INFER, &params);
    fill_all(whole, "", 256);
    fill_all(whole, "first_", 64);
    fill_all(alone, "", 256);
    assert_int_equal(nn_forward(whole), OK);
    assert_int_equal(nn_forward(alone), OK);
    const float *a = nn_output_data(whole, "normal"), *b = nn_output_data(alone, "normal");
    assert_non_null(nn_output_data(whole, "first_normal"));
    for (int i = 0; i < 2 * 256; i++) {
        near(vec3_of(a + 3 * i), vec3_of(b + 3 * i), 1e-6);
        assert_true(fabsf(vec3_length(vec3_of(a + 3 * i)) - 1) < 1e-4f);
    }
    nn_program_free(alone);
    nn_program_free(whole);
    nn_params_free(params);
}

static void the_configuration_is_written_and_read(void **state)
{
    (void)state;
    model_config again;
    nn_graph *g = NULL;
    char *json = model_config_write(&tiny);
    assert_non_null(json);
    assert_int_equal(model_config_parse(json, strlen(json), "test", &again), OK);
    assert_memory_equal(&tiny, &again, sizeof tiny);
    free(json);
    static const char odd[] = "{\"name\": \"n\", \"nfps_width\": 12}";
    assert_int_equal(model_config_parse(odd, strlen(odd), "test", &again), MERLIN_BAD_INPUT);
    assert_int_equal(model_build(&tiny, MODEL_MAPS, &g), MERLIN_WRONG_USE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_turn_takes_the_view_to_the_front_and_back),
        cmocka_unit_test(a_light_falls_off_with_distance_and_lobe),
        cmocka_unit_test(inputs_are_light_without_fall_off),
        cmocka_unit_test(a_pixels_share_does_without_its_albedo),
        cmocka_unit_test(stages_learn_by_themselves),
        cmocka_unit_test(stages_alone_give_the_wholes_normals),
        cmocka_unit_test(the_configuration_is_written_and_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
