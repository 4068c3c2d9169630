/* SPDX-License-Identifier: MIT */
/* Training with several photographs of an object: the number of photographs changes from step to step. */
#include "lab/render/generate.h"
#include "train_fixture.h"

/* Writes samples under lamps in place of the fixture's. */
static void render_lamps(const fixture *f)
{
    render_options o = render_options_default();
    render_stats stats;
    char **names = NULL;
    size_t count = 0;
    assert_int_equal(file_list(f->data, NULL, &names, &count), OK);
    for (size_t i = 0; i < count; i++)
        assert_int_equal(unlink(names[i]), 0);
    file_list_free(names, count);
    o.folder = f->data;
    o.count = SAMPLES;
    o.image = (image_settings){.size = SIZE, .fov = 10, .strata = 2, .paths = 1, .lamps = 3};
    o.widest_fov = 70;
    o.quiet = true;
    if (render_samples(&o, &stats) != OK) fail_msg("%s", status_message());
    render_stats_free(&stats);
}

static void write_several(const fixture *f, const char *model, int batch, double fewest, double most)
{
    char text[2048];
    int n = snprintf(
        text, sizeof text,
        "{\"model\": {\"name\": \"tiny\", \"input_global\": true, \"material_decoders\": 1, "
        "\"feature_sharing\": false, \"gated_attention\": true, \"relight\": \"brdf\", %s"
        "\"global_illumination\": true, \"lighting\": \"any\", \"widths\": [16, 16, 16, 16, 16], "
        "\"gi_widths\": [8, 8, 8, 8, 8]}, \"training\": {\"size\": %d, \"batch\": %d, \"fewest_pictures\": %g, "
        "\"most_pictures\": %g, "
        "\"presentations\": 32, \"learning_rate\": 3e-3, \"encoder_rate_scale\": 1, \"halve_every_epochs\": 30, "
        "\"warmup_steps\": 2, \"beta1\": 0.9, \"beta2\": 0.99, \"clip_norm\": 5, \"depth_weight\": 2, "
        "\"type\": \"f32\", \"seed\": 1, %s, \"outline_error\": 1, \"camera_turn\": 5, \"memory_gib\": 1, "
        "\"validation_count\": 4, \"validation_steps\": 4, \"curve_steps\": 2, \"checkpoint_minutes\": 100}}",
        model, SIZE, batch, fewest, most, jitter);
    if (file_write(f->config, text, (size_t)n) != OK) fail_msg("%s", status_message());
}

static const char *const several = "\"several\": true, ";

static void a_resumed_run_with_several_photographs_is_bit_identical(void **state)
{
    const fixture *f = *state;
    static const char *const files[] = {"checkpoint.safetensors", "weights.safetensors", "curves.csv",
                                        "validation.csv"};
    render_lamps(f);
    write_several(f, several, 4, 1, 4);
    if (train(f, "a", false, 0) != OK) fail_msg("%s", status_message());
    assert_int_equal(train(f, "b", false, 5), MERLIN_STOPPED);
    if (train(f, "b", true, 0) != OK) fail_msg("%s", status_message());
    for (size_t i = 0; i < sizeof files / sizeof *files; i++)
        same_file(f, "a", "b", files[i]);
}

/* A network of lights alone has no losses but theirs, and its weights hold no decoder. */
static void a_network_of_lights_alone_is_trained(void **state)
{
    const fixture *f = *state;
    size_t size;
    render_lamps(f);
    write_several(f, "\"several\": true, \"only_lights\": true, ", 4, 2, 2);
    if (train(f, "a", false, 0) != OK) fail_msg("%s", status_message());
    char *text = contents(f, "a", "weights.safetensors", &size);
    assert_non_null(memmem(text, size, "lights.fc2", 10));
    assert_non_null(memmem(text, size, "encoder.level4.exchange", 23));
    assert_null(memmem(text, size, "material.", 9));
    assert_null(memmem(text, size, ".fuse", 5));
    free(text);
}

static void senseless_numbers_of_photographs_are_refused(void **state)
{
    const fixture *f = *state;
    write_several(f, several, 4, 1, 2.5);
    assert_int_equal(train(f, "c", false, 0), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "whole number"));
    write_several(f, several, 4, 3, 2);
    assert_int_equal(train(f, "c", false, 0), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "must not be more than"));
    write_several(f, several, 4, 3, 4);
    assert_int_equal(train(f, "c", false, 0), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "no number of pictures from 3 to 4"));
    write_several(f, "", 4, 1, 2);
    assert_int_equal(train(f, "c", false, 0), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "needs a model"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_resumed_run_with_several_photographs_is_bit_identical, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_network_of_lights_alone_is_trained, set_up, tear_down),
        cmocka_unit_test_setup_teardown(senseless_numbers_of_photographs_are_refused, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
