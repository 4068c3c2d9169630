/* SPDX-License-Identifier: MIT */
/* Samples and models of random weights for the tests of evaluation. */
#ifndef MERLIN_TESTS_EVAL_EVALUATE_FIXTURE_H
#define MERLIN_TESTS_EVAL_EVALUATE_FIXTURE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <unistd.h>

#include "../../estimate/weights.h"
#include "base/file.h"
#include "estimate/photo/network.h"
#include "lab/eval/samples/evaluate.h"
#include "lab/eval/samples/sample_report.h"
#include "lab/eval/samples/truth.h"
#include "lab/render/generate.h"
#include "scratch.h"
#include "sphere.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

enum { SIZE = 64, SAMPLES = 3 };

static const model_config tiny = {.name = "tiny",
                                  .input_global = true,
                                  .material_decoders = 1,
                                  .feature_sharing = true,
                                  .gated_attention = true,
                                  .relight = MODEL_RELIGHT_NETWORK,
                                  .global_illumination = true,
                                  .lighting = MODEL_LIGHT_POINT,
                                  .widths = {8, 8, 8, 8, 8},
                                  .gi_widths = {8, 8, 8, 8, 8}};

static inline void write_weights(const char *path, const model_config *config)
{
    nn_graph *g;
    nn_params *params;
    char *json = model_config_write(config);
    assert_int_equal(model_build(config, MODEL_WHOLE, &g), OK);
    assert_int_equal(nn_params_new(g, 7, &params), OK);
    assert_int_equal(write_params(path, params, json), OK);
    free(json);
    nn_params_free(params);
    nn_graph_free(g);
}

typedef struct fixture {
    char *folder, *data, *weights, *figure;
} fixture;

/* light: of the flash picture, times what the sphere is lit with. */
static inline void write_lit_sphere(const char *folder, int index, int size, int targets, float light)
{
    sphere of = {{0.05f * (float)index, 0, -1.2f}, 0.4f, {0.2f + 0.2f * (float)index, 0.5f, 0.4f}, 0.5f, size};
    sample s;
    assert_int_equal(sphere_sample(&of, targets, &s), OK);
    s.index = (uint64_t)index;
    for (int c = 0; c < 3; c++)
        s.sh[0][c] = (float)(index + 1); /* even surroundings, brighter from one to the next */
    for (int i = 0; i < 3 * size * size; i++)
        s.direct.data[i] *= light;
    strcpy(s.shape, index == 2 ? "relief" : "union");
    char *path = sample_path(folder, s.index);
    assert_int_equal(sample_write(path, &s), OK);
    free(path);
    sample_free(&s);
}

static inline void write_sphere(const char *folder, int index, int size, int targets)
{
    write_lit_sphere(folder, index, size, targets, 1);
}

static inline int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    assert_non_null(f);
    f->folder = scratch_new();
    f->data = file_join(f->folder, "data");
    f->weights = file_join(f->folder, "tiny.safetensors");
    f->figure = file_join(f->folder, "sheet.png");
    assert_int_equal(file_make_folder(f->data), OK);
    for (int i = 0; i < SAMPLES; i++)
        write_sphere(f->data, i, SIZE, i == 0 ? 5 : 0);
    write_weights(f->weights, &tiny);
    *state = f;
    return 0;
}

static inline int tear_down(void **state)
{
    fixture *f = *state;
    scratch_remove(f->folder);
    free(f->data);
    free(f->weights);
    free(f->figure);
    free(f);
    return 0;
}

#endif
