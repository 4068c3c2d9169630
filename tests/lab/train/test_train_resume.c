/* SPDX-License-Identifier: MIT */
/* Resumed runs: from checkpoints, with less memory, by a configuration in parts, and what is refused. */
#include "sanitized.h"
#include "train_fixture.h"

/* Asserts equal parameters, running statistics, moments, weights and curves. */
static void same_run(const fixture *f, const char *a, const char *b)
{
    static const char *const files[] = {"checkpoint.safetensors", "weights.safetensors", "curves.csv",
                                        "validation.csv"};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++)
        same_file(f, a, b, files[i]);
}

static void resume_and_compare(const fixture *f, const char *lighting, const char *more)
{
    write_experiment(f, &(experiment){12, 2, 2, lighting, more, 100});
    if (train(f, "a", false, 0) != OK) fail_msg("%s", status_message());
    assert_int_equal(train(f, "b", false, 3), MERLIN_STOPPED);
    if (train(f, "b", true, 0) != OK) fail_msg("%s", status_message());
    same_run(f, "a", "b");
}

static void resumed_training_is_bit_identical(void **state)
{
    resume_and_compare(*state, "point", jitter);
}

static void resumed_training_of_both_lights_is_bit_identical(void **state)
{
    shows_figures_alone();
    resume_and_compare(*state, "both", jitter);
}

static void resumed_training_on_faulty_photographs_is_bit_identical(void **state)
{
    resume_and_compare(*state, "both",
                       "\"exposure_jitter\": 0.2, \"colour_jitter\": 0.05, \"camera_turn\": 10, "
                       "\"distance_jitter\": 0.3, \"background_leak\": 0.5, \"outline_error\": 0.5, \"jpeg\": 0.5");
}

/* The run is long enough for the mean to have changed before the stop and after. */
static void resumed_training_with_a_mean_of_the_weights_is_bit_identical(void **state)
{
    const fixture *f = *state;
    write_config(f, 34, 2, 2, "\"exposure_jitter\": 0.2, \"colour_jitter\": 0.05, \"average_decay\": 0.9");
    if (train(f, "a", false, 0) != OK) fail_msg("%s", status_message());
    assert_int_equal(train(f, "b", false, 9), MERLIN_STOPPED);
    if (train(f, "b", true, 0) != OK) fail_msg("%s", status_message());
    same_run(f, "a", "b");
}

/* A run that is killed leaves rows after its last checkpoint. */
static void rows_behind_the_checkpoint_are_dropped_on_resume(void **state)
{
    const fixture *f = *state;
    write_config(f, 12, 2, 2, jitter);
    assert_int_equal(train(f, "a", false, 0), OK);
    assert_int_equal(train(f, "b", false, 3), MERLIN_STOPPED);
    char path[600];
    snprintf(path, sizeof path, "%s/b/validation.csv", f->root);
    FILE *file = fopen(path, "a");
    assert_non_null(file);
    fputs("4,8,1,0,99\n5,10,1", file);
    fclose(file);
    assert_int_equal(train(f, "b", true, 0), OK);
    same_file(f, "a", "b", "validation.csv");
}

static char blocked[600], aside[620];

/* Makes files unwritable from the second step on. */
static int block_after_two_steps(void)
{
    if (--steps_left) return 0;
    assert_int_equal(rename(blocked, aside), 0);
    assert_int_equal(file_make_folder(blocked), OK);
    return 0;
}

/* What remains to be done after the last step is done on resume, wherever the run ended: three steps, a checkpoint at
 * each. */
static void fail_at_the_end_and_resume(const fixture *f, int validation, const char *file)
{
    write_experiment(f, &(experiment){6, 2, validation, "point", jitter, 0});
    if (train(f, "a", false, 0) != OK) fail_msg("%s", status_message());
    snprintf(blocked, sizeof blocked, "%s/b/%s", f->root, file);
    snprintf(aside, sizeof aside, "%s.aside", blocked);
    steps_left = 2;
    assert_int_equal(train_asked(f, "b", false, block_after_two_steps), MERLIN_CANNOT_WRITE);
    assert_int_equal(rmdir(blocked), 0);
    assert_int_equal(rename(aside, blocked), 0);
    if (train(f, "b", true, 0) != OK) fail_msg("%s", status_message());
    same_file(f, "a", "b", "weights.safetensors");
    same_file(f, "a", "b", "checkpoint.safetensors");
    if (validation) same_file(f, "a", "b", "validation.csv");
}

static void a_last_validation_that_failed_is_made_on_resume(void **state)
{
    fail_at_the_end_and_resume(*state, 2, "validation.csv");
}

static void last_weights_that_were_not_written_are_on_resume(void **state)
{
    fail_at_the_end_and_resume(*state, 0, "weights.safetensors");
}

static void run_is_not_overwritten_without_resume(void **state)
{
    const fixture *f = *state;
    write_config(f, 4, 2, 2, jitter);
    assert_int_equal(train(f, "a", false, 0), OK);
    assert_int_equal(train(f, "a", false, 0), MERLIN_WRONG_USE);
    assert_non_null(strstr(status_message(), "--resume"));
    assert_int_equal(train(f, "c", true, 0), MERLIN_BAD_INPUT);
}

static void checkpoint_of_another_configuration_is_refused(void **state)
{
    const fixture *f = *state;
    write_config(f, 12, 2, 2, jitter);
    assert_int_equal(train(f, "a", false, 1), MERLIN_STOPPED);
    write_config(f, 14, 2, 2, jitter);
    assert_int_equal(train(f, "a", true, 0), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "another \"presentations\""));
}

/* Rewrites the checkpoint with another value of one of its metadata. */
static void falsify_checkpoint(const char *path, const char *key, const char *value)
{
    static const char *const KEYS[] = {"checkpoint", "config", "training",   "samples",
                                       "counters",   "best",   "open_losses"};
    enum { COUNT = sizeof KEYS / sizeof *KEYS };
    const char *metadata[COUNT][2];
    safetensors_file *file;
    assert_int_equal(safetensors_open(path, &file), OK);
    for (size_t i = 0; i < COUNT; i++) {
        metadata[i][0] = KEYS[i];
        metadata[i][1] = strcmp(KEYS[i], key) == 0 ? value : safetensors_metadata(file, KEYS[i]);
    }
    safetensors_tensor *tensors = calloc(safetensors_count(file), sizeof *tensors);
    assert_non_null(tensors);
    for (size_t i = 0; i < safetensors_count(file); i++)
        tensors[i] = *safetensors_at(file, i);
    assert_int_equal(
        safetensors_write(path, tensors, safetensors_count(file), (const char *const(*)[2])metadata, COUNT), OK);
    free(tensors);
    safetensors_close(file);
}

/* The number of steps times a batch must not overflow. */
static void checkpoint_of_impossible_counts_is_refused(void **state)
{
    static const char *const LIES[][2] = {
        {"counters", "9223372036854775807 1 0"},    {"counters", "1 9223372036854775807 0"},
        {"counters", "1 1 9223372036854775807"},    {"counters", "1 1 -1"},
        {"open_losses", "9223372036854775807 0 0"}, {"best", "nan"}};
    const fixture *f = *state;
    char path[600];
    snprintf(path, sizeof path, "%s/a/checkpoint.safetensors", f->root);
    write_config(f, 12, 2, 2, jitter);
    assert_int_equal(train(f, "a", false, 1), MERLIN_STOPPED);
    size_t size;
    char *good;
    assert_int_equal(file_read(path, 1 << 28, &good, &size), OK);
    for (size_t i = 0; i < sizeof LIES / sizeof *LIES; i++) {
        assert_int_equal(file_write(path, good, size), OK);
        falsify_checkpoint(path, LIES[i][0], LIES[i][1]);
        assert_int_equal(train(f, "a", true, 0), MERLIN_BAD_INPUT);
        assert_non_null(strstr(status_message(), path));
    }
    free(good);
}

/* The memory for samples and the interval of checkpoints do not affect a run's result. */
static void a_run_goes_on_with_less_memory(void **state)
{
    const fixture *f = *state;
    write_config(f, 12, 2, 2, jitter);
    assert_int_equal(train(f, "a", false, 1), MERLIN_STOPPED);
    size_t size;
    char *text;
    assert_int_equal(file_read(f->config, 1 << 20, &text, &size), OK);
    char *memory = strstr(text, "\"memory_gib\": ");
    assert_non_null(memory);
    memory[strlen("\"memory_gib\": ")] = '0';
    assert_int_equal(file_write(f->config, text, size), OK);
    free(text);
    if (train(f, "a", true, 0) != OK) fail_msg("%s", status_message());
}

/* Writes the same configuration as three files: its model, another training, and the changes to that. */
static void write_in_parts(const fixture *f)
{
    size_t size;
    char *text, *model = file_join(f->root, "model.json"), *base = file_join(f->root, "base.json");
    assert_int_equal(file_read(f->config, 1 << 20, &text, &size), OK);
    char *begin = strstr(text, "{\"name\""), *end = strstr(text, ", \"training\""), *seed = strstr(text, "\"seed\": 1");
    assert_true(begin && end && seed);
    seed[strlen("\"seed\": ")] = '7';
    assert_int_equal(file_write(model, begin, (size_t)(end - begin)), OK);
    end[1] = '{';
    assert_int_equal(file_write(base, end + 1, size - (size_t)(end + 1 - text)), OK);
    static const char parts[] = "{\"base\": \"base.json\", \"model\": \"model.json\", \"training\": {\"seed\": 1}}";
    assert_int_equal(file_write(f->config, parts, strlen(parts)), OK);
    free(model);
    free(base);
    free(text);
}

/* A checkpoint belongs to the configuration, in however many files that is written. */
static void a_run_goes_on_by_a_configuration_in_parts(void **state)
{
    const fixture *f = *state;
    write_config(f, 12, 2, 2, jitter);
    if (train(f, "a", false, 0) != OK) fail_msg("%s", status_message());
    assert_int_equal(train(f, "b", false, 3), MERLIN_STOPPED);
    write_in_parts(f);
    if (train(f, "b", true, 0) != OK) fail_msg("%s", status_message());
    same_run(f, "a", "b");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(resumed_training_is_bit_identical, set_up, tear_down),
        cmocka_unit_test_setup_teardown(rows_behind_the_checkpoint_are_dropped_on_resume, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_last_validation_that_failed_is_made_on_resume, set_up, tear_down),
        cmocka_unit_test_setup_teardown(last_weights_that_were_not_written_are_on_resume, set_up, tear_down),
        cmocka_unit_test_setup_teardown(resumed_training_of_both_lights_is_bit_identical, set_up, tear_down),
        cmocka_unit_test_setup_teardown(resumed_training_with_a_mean_of_the_weights_is_bit_identical, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(resumed_training_on_faulty_photographs_is_bit_identical, set_up, tear_down),
        cmocka_unit_test_setup_teardown(run_is_not_overwritten_without_resume, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_run_goes_on_with_less_memory, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_run_goes_on_by_a_configuration_in_parts, set_up, tear_down),
        cmocka_unit_test_setup_teardown(checkpoint_of_another_configuration_is_refused, set_up, tear_down),
        cmocka_unit_test_setup_teardown(checkpoint_of_impossible_counts_is_refused, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
