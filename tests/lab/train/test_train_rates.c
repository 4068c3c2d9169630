/* SPDX-License-Identifier: MIT */
/* The rates of a model's parts. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include "lab/train/train_rates.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

static void what_only_several_photographs_need_learns_fastest(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        float rate;
    } expected[] = {{"encoder.level1.a.conv.weight", 0.05f * 0.2f},
                    {"encoder.level1.exchange.weight", 0.2f},
                    {"encoder.share.weight", 0.2f},
                    {"material.head.weight", 0.05f},
                    {"pixels.in.weight", 1}};
    model_config model;
    nn_graph *graph;
    nn_params *params;
    if (model_config_read(MERLIN_SOURCE_DIR "/configs/models/merlin-several.json", &model) != OK)
        fail_msg("%s", status_message());
    assert_int_equal(model_build(&model, MODEL_TRAINING, &graph), OK);
    assert_int_equal(nn_params_new(graph, 1, &params), OK);
    const train_config slow = {.encoder_rate_scale = 0.2, .single_rate_scale = 0.05};
    assert_int_equal(train_rates_set(&model, &slow, params), OK);
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        const nn_param *p = nn_params_find(params, expected[i].name);
        if (!p) fail_msg("there is no %s", expected[i].name);
        assert_float_equal(p->learning_rate_scale, expected[i].rate, 1e-7);
    }
    nn_params_free(params);
    nn_graph_free(graph);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(what_only_several_photographs_need_learns_fastest)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
