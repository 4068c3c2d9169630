/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compiled.h"
#include "model/model.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static const char *const files[] = {"table1-1", "table1-2", "table1-3", "table1-4", "table1-5",
                                    "table1-6", "table1-7", "table1-8", "table1-9", "merlin-point-plain"};
enum { FILES = sizeof files / sizeof *files };

static void read_config(const char *name, model_config *c)
{
    char path[512];
    snprintf(path, sizeof path, "%s/configs/models/%s.json", MERLIN_SOURCE_DIR, name);
    if (model_config_read(path, c) != OK) fail_msg("%s", status_message());
}

static nn_program *compile(const model_config *c, model_part part, nn_purpose purpose, int size, nn_params **params)
{
    nn_program *p = compiled(c, part, purpose, 1, size, params);
    if (!p) fail_msg("%s: %s", c->name, status_message());
    return p;
}

static void fill(float *data, size_t n, float value)
{
    for (size_t i = 0; i < n; i++)
        data[i] = value;
}

static void every_row_of_table_1_compiles_for_training(void **unused)
{
    (void)unused;
    for (int i = 0; i < FILES; i++) {
        model_config c;
        read_config(files[i], &c);
        nn_params *params = NULL;
        nn_program *p = compile(&c, MODEL_TRAINING, NN_TRAIN, 64, &params);
        fill(nn_input_data(p, "mask"), 64 * 64, 1);
        fill(nn_input_data(p, "loss_mask"), 64 * 64, 1);
        assert_int_equal(nn_forward(p), OK);
        assert_int_equal(nn_backward(p), OK);
        assert_true(isfinite(nn_total_loss(p)));
        assert_true(isnan(nn_loss(p, "indirect")) == !c.global_illumination);
        nn_program_free(p);
        nn_params_free(params);
    }
}

static void relighting_by_brdf_can_be_trained_beside_the_network(void **unused)
{
    (void)unused;
    enum { SIZE = 64, VALUES = 3 * SIZE * SIZE };
    model_config c;
    read_config("merlin-point-plain", &c);
    nn_params *params = NULL;
    nn_program *p = compile(&c, MODEL_TRAINING, NN_TRAIN, SIZE, &params);
    assert_true(isnan(nn_loss(p, "relight_brdf")));
    nn_program_free(p);
    p = compile(&c, MODEL_TRAINING_BRDF, NN_TRAIN, SIZE, &params);
    fill(nn_input_data(p, "mask"), SIZE * SIZE, 1);
    fill(nn_input_data(p, "loss_mask"), SIZE * SIZE, 1);
    fill(nn_input_data(p, "relit_true"), VALUES, 0.25f);
    nn_input_data(p, "light_position")[0] = 0.5f;
    assert_int_equal(nn_forward(p), OK);
    const float *relit = nn_output_data(p, "relit_brdf");
    double sum = 0;
    for (int i = 0; i < VALUES; i++)
        sum += ((double)relit[i] - 0.25) * ((double)relit[i] - 0.25) / (SIZE * SIZE);
    assert_float_equal(nn_loss(p, "relight_brdf"), sum, 1e-4 * sum);
    nn_program_free(p);
    nn_params_free(params);
}

static void similarity_of_relit_images_is_trained_only_where_asked_for(void **unused)
{
    (void)unused;
    enum { SIZE = 64, VALUES = 3 * SIZE * SIZE };
    static const char *const names[] = {"relight_ssim", "relight_brdf_ssim"};
    model_config c;
    read_config("merlin-point-plain", &c);
    nn_params *params = NULL;
    nn_program *p = compile(&c, MODEL_TRAINING_BRDF, NN_TRAIN, SIZE, &params);
    for (int i = 0; i < 2; i++)
        assert_true(isnan(nn_loss(p, names[i])));
    nn_program_free(p);
    p = compile(&c, MODEL_TRAINING_SSIM, NN_TRAIN, SIZE, &params);
    fill(nn_input_data(p, "mask"), SIZE * SIZE, 1);
    fill(nn_input_data(p, "loss_mask"), SIZE * SIZE, 1);
    nn_input_data(p, "light_position")[0] = 0.5f;
    assert_int_equal(nn_forward(p), OK);
    memcpy(nn_input_data(p, "relit_true"), nn_output_data(p, "relit_brdf"), VALUES * sizeof(float));
    assert_int_equal(nn_forward(p), OK);
    assert_true(fabsf(nn_loss(p, "relight_brdf_ssim")) < 1e-5f);
    assert_true(nn_loss(p, "relight_ssim") > 0.01f);
    nn_program_free(p);
    nn_params_free(params);
}

static void every_row_of_table_1_speaks_the_fixed_names(void **unused)
{
    (void)unused;
    for (int i = 0; i < FILES; i++) {
        model_config c;
        read_config(files[i], &c);
        nn_params *params = NULL;
        nn_program *p = compile(&c, MODEL_WHOLE, NN_INFER, 64, &params);
        static const char *const always[] = {"albedo", "normal", "roughness", "depth", "direct", "relit_brdf"};
        assert_int_equal(nn_forward(p), OK);
        for (int k = 0; k < 6; k++)
            assert_non_null(nn_output_data(p, always[k]));
        assert_true((nn_output_data(p, "indirect") != NULL) == c.global_illumination);
        assert_true((nn_output_data(p, "relit_direct") != NULL) == (c.relight == MODEL_RELIGHT_NETWORK));
        assert_true((nn_input_data(p, "light") != NULL) == (c.relight == MODEL_RELIGHT_NETWORK));
        nn_program_free(p);
        nn_params_free(params);
    }
}

static void rows_of_table_1_differ_in_the_papers_switches(void **unused)
{
    (void)unused;
    model_config c[10];
    for (int i = 0; i < 9; i++)
        read_config(files[i], &c[i + 1]);
    for (int i = 1; i <= 9; i++) {
        assert_int_equal(c[i].input_global, i != 6);
        assert_int_equal(c[i].material_decoders, i == 8 ? 4 : 1);
        assert_int_equal(c[i].feature_sharing, i == 2 || i >= 6);
        assert_int_equal(c[i].gated_attention, i == 3 || i >= 5);
        assert_int_equal(c[i].relight, i == 5 ? MODEL_RELIGHT_BRDF : MODEL_RELIGHT_NETWORK);
        assert_int_equal(c[i].global_illumination, i == 4 || i == 5 || i >= 8);
    }
}

/* Asserts the project's budget: 12 M parameters and 10 GMAC at 256×256 for everything together. */
static void keeps_the_budget(const char *name)
{
    model_config c;
    read_config(name, &c);
    nn_params *params = NULL;
    nn_program *p = compile(&c, MODEL_WHOLE, NN_INFER, 256, &params);
    nn_cost cost = nn_program_cost(p);
    double gmac = cost.forward_flops / 2e9;
    print_message("%s: %.2f M parameters, %.2f GMAC at 256x256\n", name, (double)cost.parameter_count / 1e6, gmac);
    assert_true(cost.parameter_count <= 12000000);
    assert_true(gmac <= 10);
    assert_true(gmac >= 1); /* a cost of zero would satisfy any budget */
    nn_program_free(p);
    nn_params_free(params);
}

static void default_models_keep_the_budget(void **unused)
{
    (void)unused;
    keeps_the_budget("merlin-point-plain");
    keeps_the_budget("merlin-point-deep");
    keeps_the_budget("merlin-point-fine");
    keeps_the_budget("merlin-point");
    keeps_the_budget("merlin-env-deep");
    keeps_the_budget("merlin-env-fine");
    keeps_the_budget("merlin-env");
}

/* They can thus be added to weights that are trained already. */
static void residual_blocks_begin_as_nothing(void **unused)
{
    (void)unused;
    enum { SIZE = 64, VALUES = 3 * SIZE * SIZE };
    model_config plain, deep;
    read_config("merlin-point-plain", &plain);
    read_config("merlin-point-deep", &deep);
    nn_params *a = NULL, *b = NULL;
    /* initial values depend on name and seed: what both have is the same */
    nn_program *p = compile(&plain, MODEL_WHOLE, NN_INFER, SIZE, &a),
               *q = compile(&deep, MODEL_WHOLE, NN_INFER, SIZE, &b);
    assert_true(nn_params_count(b) > nn_params_count(a));
    fill(nn_input_data(p, "image"), VALUES, 0.7f), fill(nn_input_data(q, "image"), VALUES, 0.7f);
    fill(nn_input_data(p, "mask"), SIZE * SIZE, 1), fill(nn_input_data(q, "mask"), SIZE * SIZE, 1);
    assert_int_equal(nn_forward(p), OK);
    assert_int_equal(nn_forward(q), OK);
    const float *without = nn_output_data(p, "albedo"), *with = nn_output_data(q, "albedo");
    assert_memory_equal(without, with, VALUES * sizeof(float));
    nn_param *weight = nn_params_find(b, "material.level1.block1.b.norm.weight");
    assert_non_null(weight);
    fill(weight->value, weight->count, 1);
    nn_params_touch(b);
    assert_int_equal(nn_forward(q), OK);
    assert_memory_not_equal(without, with, VALUES * sizeof(float));
    nn_program_free(p), nn_program_free(q);
    nn_params_free(a), nn_params_free(b);
}

/* The same weights in MODEL_INDIRECT give the whole model's result for the same maps. */
static void indirect_part_equals_the_whole_models(void **unused)
{
    (void)unused;
    enum { SIZE = 64, PIXELS = SIZE * SIZE };
    model_config c;
    read_config("merlin-point-plain", &c);
    nn_params *params = NULL;
    nn_program *whole = compile(&c, MODEL_WHOLE, NN_INFER, SIZE, &params);
    nn_program *part = compile(&c, MODEL_INDIRECT, NN_INFER, SIZE, &params);
    float *image = nn_input_data(whole, "image"), *mask = nn_input_data(whole, "mask");
    for (int i = 0; i < 3 * PIXELS; i++)
        image[i] = (float)(i % 17) / 17;
    for (int i = 0; i < PIXELS; i++)
        mask[i] = i % SIZE > SIZE / 4;
    assert_int_equal(nn_forward(whole), OK);
    static const char *const names[] = {"direct", "albedo", "normal", "roughness", "depth"};
    static const int channels[] = {3, 3, 3, 1, 1};
    for (int k = 0; k < 5; k++)
        memcpy(nn_input_data(part, names[k]), nn_output_data(whole, names[k]),
               (size_t)channels[k] * PIXELS * sizeof(float));
    memcpy(nn_input_data(part, "mask"), mask, PIXELS * sizeof(float));
    assert_int_equal(nn_forward(part), OK);
    const float *a = nn_output_data(whole, "indirect"), *b = nn_output_data(part, "indirect");
    float largest = 0;
    for (int i = 0; i < 3 * PIXELS; i++) {
        assert_float_equal(a[i], b[i], 1e-5); /* the same float32 arithmetic; sums may be in another order */
        largest = fmaxf(largest, fabsf(a[i]));
        if (mask[i / 3] == 0) assert_true(a[i] == 0);
    }
    assert_true(largest > 1e-4f);
    nn_program_free(whole);
    nn_program_free(part);
    nn_params_free(params);
}

/* The decoder on features of MODEL_MAPS gives the whole model's result for photograph and light at once. */
static void relighting_part_equals_the_whole_models(const char *name)
{
    enum { SIZE = 64, PIXELS = SIZE * SIZE };
    model_config c;
    read_config(name, &c);
    nn_params *params = NULL;
    nn_program *programs[] = {compile(&c, MODEL_WHOLE, NN_INFER, SIZE, &params),
                              compile(&c, MODEL_MAPS, NN_INFER, SIZE, &params)};
    nn_program *part = compile(&c, MODEL_RELIGHT, NN_INFER, SIZE, &params);
    for (int k = 0; k < 2; k++) {
        for (int i = 0; i < 3 * PIXELS; i++)
            nn_input_data(programs[k], "image")[i] = (float)(i % 17) / 17;
        for (int i = 0; i < PIXELS; i++)
            nn_input_data(programs[k], "mask")[i] = nn_input_data(part, "mask")[i] = i % SIZE > SIZE / 4;
    }
    for (int i = 0; i < model_light_size(&c); i++)
        nn_input_data(programs[0], "light")[i] = nn_input_data(part, "light")[i] = 0.4f - 0.1f * (float)(i % 5);
    for (int k = 0; k < 2; k++)
        assert_int_equal(nn_forward(programs[k]), OK);
    for (int k = 0; k < MODEL_FEATURES; k++) {
        int level = k % MODEL_LEVELS, side = SIZE >> (level + 1);
        const float *from = nn_output_data(programs[1], model_features[k]);
        assert_true(!from == !nn_input_data(part, model_features[k]));
        if (from)
            memcpy(nn_input_data(part, model_features[k]), from,
                   (size_t)(side * side * c.widths[level]) * sizeof *from);
    }
    assert_int_equal(nn_forward(part), OK);
    const float *a = nn_output_data(programs[0], "relit_direct"), *b = nn_output_data(part, "relit_direct");
    float least = 1, largest = 0;
    for (int i = 0; i < 3 * PIXELS; i++) {
        assert_float_equal(a[i], b[i], 1e-5);
        if (nn_input_data(part, "mask")[i / 3] == 0) continue;
        least = fminf(least, a[i]);
        largest = fmaxf(largest, a[i]);
    }
    assert_true(largest - least > 1e-3f);
    assert_null(nn_output_data(programs[1], "relit_direct"));
    nn_program_free(programs[0]), nn_program_free(programs[1]), nn_program_free(part);
    nn_params_free(params);
}

static void relighting_parts_equal_their_models(void **unused)
{
    (void)unused;
    relighting_part_equals_the_whole_models("merlin-point-plain");
    relighting_part_equals_the_whole_models("merlin-env-deep");
    relighting_part_equals_the_whole_models("table1-3"); /* without feature sharing */
}

static void models_without_the_decoder_have_no_part_for_it(void **unused)
{
    (void)unused;
    model_config c;
    nn_graph *g = NULL;
    read_config("table1-5", &c);
    assert_int_equal(model_build(&c, MODEL_RELIGHT, &g), MERLIN_WRONG_USE);
    assert_null(g);
}

static void maps_stay_in_their_ranges(void **unused)
{
    (void)unused;
    enum { SIZE = 64, PIXELS = SIZE * SIZE };
    model_config c;
    read_config("merlin-point-plain", &c);
    nn_params *params = NULL;
    nn_program *p = compile(&c, MODEL_WHOLE, NN_INFER, SIZE, &params);
    fill(nn_input_data(p, "image"), 3 * PIXELS, 0.7f);
    fill(nn_input_data(p, "mask"), PIXELS, 1);
    assert_int_equal(nn_forward(p), OK);
    const float *albedo = nn_output_data(p, "albedo"), *normal = nn_output_data(p, "normal");
    const float *depth = nn_output_data(p, "depth"), *relit = nn_output_data(p, "relit_direct");
    for (int i = 0; i < PIXELS; i++) {
        const float *n = normal + 3 * i;
        assert_float_equal(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1, 1e-4);
        assert_in_range((int)(depth[i] * 1000), 377, 4000); /* 1 / 2.65 to 1 / 0.25 */
        for (int k = 0; k < 3; k++) {
            assert_true(fabsf(albedo[3 * i + k]) <= 1);
            assert_true(relit[3 * i + k] >= 0 && relit[3 * i + k] <= 1);
        }
    }
    nn_program_free(p);
    nn_params_free(params);
}

static void image_is_encoded_as_square_root(void **unused)
{
    (void)unused;
    const float linear[] = {-1, 0, 0.25f, 2.25f, 9};
    float encoded[5];
    model_encode_image(linear, encoded, 5);
    const float expected[] = {0, 0, 0.5f, 1.5f, 2}; /* nothing above MODEL_BRIGHTEST */
    for (int i = 0; i < 5; i++)
        assert_true(encoded[i] == expected[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_row_of_table_1_compiles_for_training),
        cmocka_unit_test(relighting_by_brdf_can_be_trained_beside_the_network),
        cmocka_unit_test(similarity_of_relit_images_is_trained_only_where_asked_for),
        cmocka_unit_test(every_row_of_table_1_speaks_the_fixed_names),
        cmocka_unit_test(rows_of_table_1_differ_in_the_papers_switches),
        cmocka_unit_test(default_models_keep_the_budget),
        cmocka_unit_test(residual_blocks_begin_as_nothing),
        cmocka_unit_test(indirect_part_equals_the_whole_models),
        cmocka_unit_test(relighting_parts_equal_their_models),
        cmocka_unit_test(models_without_the_decoder_have_no_part_for_it),
        cmocka_unit_test(maps_stay_in_their_ranges),
        cmocka_unit_test(image_is_encoded_as_square_root),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
