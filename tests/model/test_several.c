/* SPDX-License-Identifier: MIT */
/* The network of several photographs: of one it makes what the network of one makes, their order does not matter, and
 * objects of a batch do not see each other. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/rng.h"
#include "model/model.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { SIZE = 64, PIXELS = SIZE * SIZE };

static model_config tiny(bool several)
{
    model_config c;
    if (model_config_read(MERLIN_SOURCE_DIR "/configs/models/merlin-several.json", &c) != OK)
        fail_msg("%s", status_message());
    assert_true(c.several);
    for (int i = 0; i < MODEL_LEVELS; i++)
        c.widths[i] = c.gi_widths[i] = 16, c.encoder_blocks[i] = 1;
    c.several = several;
    return c;
}

static nn_program *compiled_for(const model_config *c, int pictures, int objects, nn_params **params)
{
    nn_graph *g = NULL;
    nn_program *p = NULL;
    const nn_options options = {.batch = pictures * objects, .group = pictures, .height = SIZE, .width = SIZE};
    status s = model_build(c, MODEL_WHOLE, &g);
    if (s == OK && !*params) s = nn_params_new(g, 7, params);
    if (s == OK) s = nn_compile(g, *params, &options, &p);
    if (s != OK) fail_msg("%s", status_message());
    nn_graph_free(g);
    return p;
}

/* Fills a picture's inputs with numbers of its own. */
static void fill_picture(nn_program *p, size_t slot, uint64_t number)
{
    rng r = rng_at(3, number, 0);
    for (size_t i = 0; i < 3 * PIXELS; i++)
        nn_input_data(p, "image")[3 * slot * PIXELS + i] = rng_uniform(&r);
    for (size_t i = 0; i < MODEL_SIGHT * PIXELS; i++)
        nn_input_data(p, "sight")[MODEL_SIGHT * slot * PIXELS + i] = rng_uniform(&r);
}

static void fill_object(nn_program *p, size_t slot)
{
    for (size_t i = 0; i < PIXELS; i++)
        nn_input_data(p, "mask")[slot * PIXELS + i] = 1;
    const float lens[3] = {0.5f, 0, 0}, light[3] = {0.25f, 0, 0};
    memcpy(nn_input_data(p, "lens") + 3 * slot, lens, sizeof lens);
    memcpy(nn_input_data(p, "light_position") + 3 * slot, light, sizeof light);
}

/* Gives the layers that add nothing at first something to add. */
static void train_all(nn_params *params)
{
    for (size_t i = 0; i < nn_params_count(params); i++) {
        nn_param *q = nn_params_at(params, i);
        rng r = rng_at(9, i, 0);
        const bool is_new = strstr(q->name, "exchange") || strstr(q->name, "attention") || strstr(q->name, "fuse.") ||
                            strstr(q->name, "visibility.own");
        for (size_t k = 0; k < q->count && is_new; k++)
            q->value[k] += rng_range(&r, -0.1f, 0.1f);
    }
    nn_params_touch(params);
}

static const char *const of_object[] = {"albedo", "normal", "roughness", "depth", "direct", "indirect", "relit_brdf"};
static const int channels[] = {3, 3, 1, 1, 3, 3, 3};
enum { OF_OBJECT = sizeof of_object / sizeof *of_object };

static void run(nn_program *p)
{
    if (nn_forward(p) != OK) fail_msg("%s", status_message());
}

static void assert_same_output(const char *name, const float *a, const float *b, size_t count, float tolerance)
{
    assert_true(a && b);
    for (size_t i = 0; i < count; i++)
        if (!(fabsf(a[i] - b[i]) <= tolerance))
            fail_msg("%s: value %zu is %g and %g", name, i, (double)a[i], (double)b[i]);
}

static void one_photograph_gives_what_the_network_of_one_gives(void **state)
{
    (void)state;
    const model_config one = tiny(false), several = tiny(true);
    nn_params *params[2] = {NULL, NULL};
    nn_program *p[2] = {compiled_for(&several, 1, 1, &params[0]), compiled_for(&one, 1, 1, &params[1])};
    for (size_t i = 0; i < nn_params_count(params[1]); i++) {
        nn_param *to = nn_params_at(params[1], i);
        const nn_param *from = nn_params_find(params[0], to->name);
        assert_non_null(from);
        memcpy(to->value, from->value, to->count * sizeof(float));
    }
    nn_params_touch(params[1]);
    for (int k = 0; k < 2; k++) {
        fill_picture(p[k], 0, 1);
        fill_object(p[k], 0);
        run(p[k]);
    }
    for (int i = 0; i < OF_OBJECT; i++)
        assert_same_output(of_object[i], nn_output_data(p[0], of_object[i]), nn_output_data(p[1], of_object[i]),
                           (size_t)channels[i] * PIXELS, 0);
    assert_same_output("lights", nn_output_data(p[0], "lights"), nn_output_data(p[1], "lights"), MODEL_LIGHTS, 0);
    assert_same_output("visibility", nn_output_data(p[0], "visibility"), nn_output_data(p[1], "visibility"), PIXELS, 0);
    for (int k = 0; k < 2; k++) {
        nn_program_free(p[k]);
        nn_params_free(params[k]);
    }
}

static void the_order_of_photographs_does_not_matter(void **state)
{
    (void)state;
    enum { PICTURES = 3 };
    static const size_t order[2][PICTURES] = {{0, 1, 2}, {2, 0, 1}};
    const model_config c = tiny(true);
    nn_params *params = NULL;
    nn_program *p[2] = {compiled_for(&c, PICTURES, 1, &params), compiled_for(&c, PICTURES, 1, &params)};
    train_all(params);
    for (int k = 0; k < 2; k++) {
        for (size_t i = 0; i < PICTURES; i++)
            fill_picture(p[k], i, order[k][i]);
        fill_object(p[k], 0);
        run(p[k]);
    }
    for (int i = 0; i < OF_OBJECT; i++) /* sums in another order */
        assert_same_output(of_object[i], nn_output_data(p[0], of_object[i]), nn_output_data(p[1], of_object[i]),
                           (size_t)channels[i] * PIXELS, 1e-3f);
    const float *lights[2] = {nn_output_data(p[0], "lights"), nn_output_data(p[1], "lights")};
    float apart = 0;
    for (size_t i = 0; i < PICTURES; i++) {
        assert_same_output("lights", lights[0] + MODEL_LIGHTS * order[1][i], lights[1] + MODEL_LIGHTS * i, MODEL_LIGHTS,
                           1e-4f);
        apart = fmaxf(apart, fabsf(lights[0][MODEL_LIGHTS * i] - lights[0][0]));
    }
    assert_true(apart > 1e-4f); /* each photograph has its own light */
    nn_program_free(p[0]), nn_program_free(p[1]);
    nn_params_free(params);
}

static void objects_do_not_see_each_other_and_photographs_do(void **state)
{
    (void)state;
    enum { PICTURES = 2 };
    const model_config c = tiny(true);
    nn_params *params = NULL;
    nn_program *p = compiled_for(&c, PICTURES, 2, &params);
    train_all(params);
    float *first = malloc(3 * 3 * PIXELS * sizeof *first);
    for (uint64_t k = 0; k < 3; k++) { /* the second object's photographs change, then one of the first's */
        for (size_t i = 0; i < 2 * PICTURES; i++)
            fill_picture(p, i, (k > 0 && i > 1) || (k > 1 && i == 1) ? 10 + i : i);
        fill_object(p, 0), fill_object(p, 1);
        run(p);
        memcpy(first + 3 * k * PIXELS, nn_output_data(p, "albedo"), 3 * PIXELS * sizeof *first);
    }
    assert_memory_equal(first, first + 3 * PIXELS, 3 * PIXELS * sizeof *first);
    assert_memory_not_equal(first, first + 6 * PIXELS, 3 * PIXELS * sizeof *first);
    free(first);
    nn_program_free(p);
    nn_params_free(params);
}

/* A matte surface's shares are those of its cosines, whatever its albedo and the pictures' exposures; a pixel that is
 * black in all pictures, or of one picture alone, has no share. */
static void shares_do_without_albedo_and_exposure(void **state)
{
    (void)state;
    enum { SHARES = 3, COUNT = 4 };
    static const float cosine[SHARES][COUNT] = {{1, 0.5f, 0, 0.5f}, {0.2f, 0.9f, 0, 0.9f}, {0, 0.6f, 0, 1.4f}};
    static const float albedo[COUNT] = {0.9f, 0.1f, 0.5f, 0.4f}, exposure[SHARES] = {1, 0.3f, 2};
    float images[SHARES * COUNT * 3], shares[SHARES * COUNT];
    for (int k = 0; k < SHARES; k++)
        for (int i = 0; i < 3 * COUNT; i++)
            images[3 * COUNT * k + i] = sqrtf(exposure[k] * albedo[i / 3] * cosine[k][i / 3]);
    model_encode_shares(images, SHARES, COUNT, shares);
    for (int i = 0; i < COUNT; i++) {
        double light[SHARES], squares = 0;
        for (int k = 0; k < SHARES; k++) {
            double mean = 0;
            for (int j = 0; j < COUNT; j++)
                mean += (double)(albedo[j] * cosine[k][j]) / COUNT;
            light[k] = (double)cosine[k][i] / mean;
            squares += light[k] * light[k] / SHARES;
        }
        for (int k = 0; k < SHARES; k++)
            assert_float_equal(shares[COUNT * k + i], i == 2 ? 0 : light[k] / sqrt(squares) - 1, 1e-5);
    }
    model_encode_shares(images, 1, COUNT, shares);
    for (int i = 0; i < COUNT; i++)
        assert_true(shares[i] == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_photograph_gives_what_the_network_of_one_gives),
        cmocka_unit_test(the_order_of_photographs_does_not_matter),
        cmocka_unit_test(objects_do_not_see_each_other_and_photographs_do),
        cmocka_unit_test(shares_do_without_albedo_and_exposure),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
