/* SPDX-License-Identifier: MIT */
/* Compares operations over several pictures with PyTorch in double precision: tests/reference/make_groups.py writes the
 * vectors. Float32 leaves some 1e-6 of a result; bfloat16 rounds each of ten layers' values by 2^-9. */
#include "reference.h"

enum { OBJECTS = 2, PICTURES = 3, COUNT = OBJECTS * PICTURES, SIZE = 6, CHANNELS = 8, HEADS = 2, POINTS = 5 };
enum { ABSENT = 4 }; /* picture that is left out */
static const float rate = 0.01f;

static nn_graph *net(void)
{
    nn_graph *g = nn_graph_new();
    nn_node *present = nn_input(g, "present", 1, NN_VECTOR), *image = nn_compute(g, nn_input(g, "image", 3, 1));
    nn_node *x = nn_tanh(g, nn_conv2d(g, image, "first", CHANNELS, 1, 1, NN_BIAS));
    x = nn_layer_norm(g, x, "norm");
    nn_node *seen = nn_group_attention(g, nn_conv2d(g, x, "attention", 3 * CHANNELS, 1, 1, NN_BIAS), present, HEADS);
    nn_node *pooled =
        nn_group_pool(g, nn_conv2d(g, seen, "pooled", 2 * CHANNELS, 1, 1, NN_BIAS), present, "pool", HEADS);
    nn_node *all[] = {nn_group_max(g, x, present), nn_group_mean(g, x, present), nn_group_spread(g, x, present),
                      pooled};
    nn_node *common = nn_conv2d(g, nn_concat(g, all, 4), "common", CHANNELS, 1, 1, NN_BIAS);
    x = nn_tanh(g, nn_concat(g, (nn_node *[]){seen, nn_group_repeat(g, common)}, 2));
    x = nn_gather(g, x, nn_group_input(g, "places", 2, NN_POINTS));
    x = nn_float(g, nn_conv2d(g, x, "last", 3, 1, 1, NN_BIAS));
    nn_output(g, x, "output");
    nn_masked_l2(g, x, nn_input(g, "target", 3, NN_POINTS), nn_input(g, "mask", 1, NN_POINTS), "loss", 1);
    return g;
}

static void fill_inputs(nn_program *p)
{
    reference_fill(nn_input_data(p, "image"), "image", COUNT * SIZE * SIZE * 3, 1, 0);
    reference_fill(nn_input_data(p, "places"), "places", OBJECTS * POINTS * 2, 4, 2.5);
    reference_fill(nn_input_data(p, "target"), "target", COUNT * POINTS * 3, 1, 0);
    for (int i = 0; i < COUNT; i++)
        nn_input_data(p, "present")[i] = i != ABSENT;
    for (int i = 0; i < COUNT * POINTS; i++)
        nn_input_data(p, "mask")[i] = 1;
}

/* Takes one step, and compares how each parameter changed. */
static void compare_step(const safetensors_file *f, nn_params *params, double tolerance)
{
    const nn_adam_options options = {
        .beta1 = 0.9f, .beta2 = 0.999f, .epsilon = 1e-3f, .clip_norm = 0, .weight_decay = 0.1f};
    nn_adam *adam = NULL;
    float before[32 * CHANNELS * CHANNELS];
    assert_int_equal(nn_adam_new(params, &options, &adam), OK);
    for (size_t i = 0, at = 0; i < nn_params_count(params); at += nn_params_at(params, i++)->count)
        memcpy(before + at, nn_params_at(params, i)->value, nn_params_at(params, i)->count * sizeof *before);
    assert_int_equal(nn_adam_step(adam, rate), OK);
    for (size_t i = 0, at = 0; i < nn_params_count(params); i++) {
        const nn_param *p = nn_params_at(params, i);
        for (size_t k = 0; k < p->count; k++, at++)
            before[at] = (p->value[k] - before[at]) / rate;
        reference_compare(f, "step", p->name, before + at - p->count, tolerance);
    }
    nn_adam_free(adam);
}

static void compare_with_pytorch(nn_type type, double output, double gradient, double step)
{
    safetensors_file *f;
    nn_graph *g = net();
    nn_params *params;
    nn_program *p;
    const nn_options options = {.batch = COUNT,
                                .height = SIZE,
                                .width = SIZE,
                                .group = PICTURES,
                                .points = POINTS,
                                .type = type,
                                .purpose = NN_TRAIN};
    if (safetensors_open(MERLIN_SOURCE_DIR "/tests/reference/groups.safetensors", &f) != OK)
        fail_msg("%s", status_message());
    assert_int_equal(nn_params_new(g, 1, &params), OK);
    reference_fill_params(params);
    if (nn_compile(g, params, &options, &p) != OK) fail_msg("%s", status_message());
    fill_inputs(p);
    assert_int_equal(nn_forward(p), OK);
    const float loss = nn_total_loss(p);
    assert_true(reference_distance(safetensors_find(f, "loss"), &loss) <= output);
    assert_true(reference_distance(safetensors_find(f, "output"), nn_output_data(p, "output")) <= output);
    assert_int_equal(nn_backward(p), OK);
    for (size_t i = 0; i < nn_params_count(params); i++)
        reference_compare(f, "gradient", nn_params_at(params, i)->name, nn_params_at(params, i)->gradient, gradient);
    compare_step(f, params, step);
    nn_program_free(p);
    nn_params_free(params);
    nn_graph_free(g);
    safetensors_close(f);
}

static void several_pictures_train_as_in_pytorch(void **state)
{
    (void)state;
    compare_with_pytorch(NN_FLOAT32, 1e-6, 1e-5, 1e-3);
}

static void in_bfloat16_to_its_rounding(void **state)
{
    (void)state;
    compare_with_pytorch(NN_BFLOAT16, 0.02, 0.1, 0.1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(several_pictures_train_as_in_pytorch),
        cmocka_unit_test(in_bfloat16_to_its_rounding),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
