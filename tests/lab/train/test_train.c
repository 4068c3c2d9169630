/* SPDX-License-Identifier: MIT */
#include "sanitized.h"
#include "train_fixture.h"

/* Trains a run that starts from the weights in `begins`. */
static status train_beginning(const fixture *f, const char *name, train_options begins)
{
    char *output = file_join(f->root, name);
    begins.config = f->config;
    begins.data = f->data;
    begins.output = output;
    begins.quiet = true;
    status s = train_run(&begins);
    free(output);
    return s;
}

static status train_from(const fixture *f, const char *name, const char *weights)
{
    return train_beginning(f, name, (train_options){.init = weights});
}

static status train_from_shared(const fixture *f, const char *name, const char *const *weights)
{
    return train_beginning(f, name, (train_options){.init_shared = weights});
}

/* Returns the column of a loss in curves.csv. */
static int column_of(const char *loss)
{
    int i = 0;
    while (strcmp(model_losses[i], loss) != 0)
        i++;
    return 5 + i;
}

static double value_in(const char *row, int column)
{
    double value = NAN;
    for (int i = 0; row && i < column; i++)
        row = strchr(row + 1, ',');
    assert_non_null(row);
    assert_int_equal(sscanf(row + (column > 0), "%lf", &value), 1);
    return value;
}

/* Asserts that a column of curves.csv (0: step) ends below this share of its first row, which is the mean of the first
 * four steps. */
static void loss_falls_to(const fixture *f, int column, double share)
{
    size_t size;
    char *text = contents(f, "a", "curves.csv", &size), *line = strchr(text, '\n') + 1;
    double first = 0, last = 0;
    for (; line && *line; line = strchr(line, '\n') + 1) {
        last = value_in(line, column);
        if (first == 0) first = last;
    }
    print_message("column %d from %.3f to %.3f\n", column, first, last);
    assert_true(last < share * first);
    free(text);
}

static void losses_fall_on_two_samples(void **state)
{
    shows_figures_alone();
    const fixture *f = *state;
    for (int i = 2; i < SAMPLES; i++) {
        char *path = sample_path(f->data, (uint64_t)i);
        unlink(path);
        free(path);
    }
    write_config(f, 240, 4, 0, no_jitter);
    if (train(f, "a", false, 0) != OK) fail_msg("%s", status_message());
    loss_falls_to(f, 4, 0.3);
}

/* Returns the total loss in the first row of curves.csv minus the weighted sum of the losses in that row. */
static double unexplained(const fixture *f, const char *run, double albedo_weight)
{
    size_t size;
    char *text = contents(f, run, "curves.csv", &size), *row = strchr(text, '\n') + 1;
    const int total = 4, losses = column_of("relight") - column_of("albedo") + 1;
    double sum = value_in(row, total);
    for (int i = 0; i < losses; i++) {
        const char *name = model_losses[i];
        bool twice = strcmp(name, "normal") == 0 || strcmp(name, "depth") == 0;
        double weight = strcmp(name, "albedo") == 0 ? albedo_weight : twice ? 2 : 1;
        sum -= weight * value_in(row, column_of(name));
    }
    assert_true(value_in(row, column_of("albedo")) > 0.01);
    free(text);
    return sum;
}

static void albedo_weighs_what_the_configuration_says(void **state)
{
    const fixture *f = *state;
    char more[200];
    snprintf(more, sizeof more, "%s, \"albedo_weight\": 3", no_jitter);
    write_config(f, 16, 4, 0, no_jitter);
    assert_int_equal(train(f, "a", false, 0), OK);
    write_config(f, 16, 4, 0, more);
    assert_int_equal(train(f, "b", false, 0), OK);
    assert_float_equal(unexplained(f, "a", 1), 0, 1e-4);
    assert_float_equal(unexplained(f, "b", 3), 0, 1e-4);
}

static void both_lights_can_be_learned(void **state)
{
    shows_figures_alone();
    const fixture *f = *state;
    write_experiment(f, &(experiment){96, 4, 0, "both", no_jitter, 100});
    if (train(f, "a", false, 0) != OK) fail_msg("%s", status_message());
    loss_falls_to(f, 4, 0.5);
    loss_falls_to(f, column_of("environment"), 0.5);
}

static void charts_are_drawn_of_rows_with_fewer_losses(void **state)
{
    const fixture *f = *state;
    char csv[300], png[300];
    snprintf(csv, sizeof csv, "%s/old.csv", f->root);
    snprintf(png, sizeof png, "%s/old.png", f->root);
    static const char rows[] = "step,presentations,learning_rate,skipped,total,albedo\n4,8,1,0,2,1\n8,16,1,0,1,0.5\n";
    assert_int_equal(file_write(csv, rows, sizeof rows - 1), OK);
    assert_int_equal(train_curve_chart(csv, "/nonexistent", png), OK);
    assert_true(file_exists(png));
}

static void a_chart_that_cannot_be_drawn_does_not_end_training(void **state)
{
    const fixture *f = *state;
    char folder[300], weights[300];
    snprintf(folder, sizeof folder, "%s/chartless/curves.png", f->root);
    snprintf(weights, sizeof weights, "%s/chartless/weights.safetensors", f->root);
    assert_int_equal(file_make_folder(folder), OK);
    write_experiment(f, &(experiment){4, 4, 0, "both", no_jitter, 100});
    if (train(f, "chartless", false, 0) != OK) fail_msg("%s", status_message());
    assert_true(file_exists(weights));
}

static void a_curve_cut_within_its_header_begins_anew(void **state)
{
    const fixture *f = *state;
    char csv[300], *text;
    size_t size;
    snprintf(csv, sizeof csv, "%s/cut.csv", f->root);
    assert_int_equal(file_write(csv, "step,pres", 9), OK);
    assert_int_equal(train_curve_truncate(csv, 4), OK);
    assert_int_equal(train_curve_append(csv, &(train_curve_row){.step = 5}, &(train_losses){.count = 1}), OK);
    assert_int_equal(train_curve_append(csv, &(train_curve_row){.step = 6}, &(train_losses){.count = 1}), OK);
    assert_int_equal(file_read(csv, 1 << 12, &text, &size), OK);
    assert_int_equal(strncmp(text, "step,presentations,", 19), 0);
    assert_null(strstr(text + 1, "step,"));
    assert_non_null(strstr(text, "\n5,"));
    assert_non_null(strstr(text, "\n6,"));
    free(text);
}

static void weights_without_a_checkpoint_are_kept(void **state)
{
    const fixture *f = *state;
    char path[256];
    write_config(f, 4, 2, 2, jitter);
    assert_int_equal(train(f, "a", false, 0), OK);
    snprintf(path, sizeof path, "%s/a/checkpoint.safetensors", f->root);
    assert_int_equal(unlink(path), 0);
    snprintf(path, sizeof path, "%s/a/validation.csv", f->root);
    struct stat before, after;
    assert_int_equal(stat(path, &before), 0);
    assert_int_equal(train(f, "a", false, 0), MERLIN_WRONG_USE);
    assert_non_null(strstr(status_message(), "checkpoint is gone"));
    assert_int_equal(stat(path, &after), 0);
    assert_true(before.st_size > 0 && after.st_size == before.st_size);
}

static void more_held_back_than_there_are_is_refused(void **state)
{
    const fixture *f = *state;
    write_config(f, 4, 2, SAMPLES, jitter);
    assert_int_equal(train(f, "a", false, 0), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "validation_count"));
    char *output = file_join(f->root, "a");
    assert_false(file_exists(output)); /* no folder is left behind */
    free(output);
}

static void exported_weights_load_as_a_model(void **state)
{
    const fixture *f = *state;
    write_config(f, 4, 2, 2, jitter);
    assert_int_equal(train(f, "a", false, 0), OK);
    char path[600];
    snprintf(path, sizeof path, "%s/a/weights.safetensors", f->root);
    model_config c;
    nn_params *params;
    if (model_load(path, &c, &params) != OK) fail_msg("%s", status_message());
    assert_string_equal(c.name, "tiny");
    assert_true(nn_params_count(params) > 50);
    nn_params_free(params);
}

static void weights_that_a_run_starts_from_are_not_replaced(void **state)
{
    const fixture *f = *state;
    write_config(f, 4, 2, 2, jitter);
    assert_int_equal(train(f, "a", false, 0), OK);
    char checkpoint[600], weights[600];
    snprintf(checkpoint, sizeof checkpoint, "%s/a/checkpoint.safetensors", f->root);
    snprintf(weights, sizeof weights, "%s/a/../a/weights.safetensors", f->root);
    assert_int_equal(remove(checkpoint), 0);
    assert_int_equal(train_from(f, "a", weights), MERLIN_WRONG_USE);
    assert_non_null(strstr(status_message(), "name another folder"));
    assert_int_equal(train_from(f, "b", weights), OK);
}

static void later_shared_weights_replace_earlier_ones(void **state)
{
    const fixture *f = *state;
    char weights[2][600];
    write_config(f, 8, 2, 0, jitter);
    assert_int_equal(train(f, "a", false, 0), OK);
    write_config(f, 4, 2, 0, jitter);
    assert_int_equal(train(f, "b", false, 0), OK);
    for (int i = 0; i < 2; i++)
        snprintf(weights[i], sizeof weights[i], "%s/%s/weights.safetensors", f->root, i == 0 ? "a" : "b");
    assert_int_equal(train_from(f, "from b", weights[1]), OK);
    assert_int_equal(train_from_shared(f, "b alone", (const char *const[]){weights[1], NULL}), OK);
    assert_int_equal(train_from_shared(f, "b last", (const char *const[]){weights[0], weights[1], NULL}), OK);
    assert_int_equal(train_from_shared(f, "a last", (const char *const[]){weights[1], weights[0], NULL}), OK);
    same_file(f, "from b", "b alone", "weights.safetensors");
    same_file(f, "from b", "b last", "weights.safetensors");
    assert_int_equal(train_from(f, "from a", weights[0]), OK);
    same_file(f, "from a", "a last", "weights.safetensors");
    char checkpoint[600];
    snprintf(checkpoint, sizeof checkpoint, "%s/b/checkpoint.safetensors", f->root);
    assert_int_equal(remove(checkpoint), 0);
    assert_int_equal(train_from_shared(f, "b", (const char *const[]){weights[0], weights[1], NULL}), MERLIN_WRONG_USE);
    assert_non_null(strstr(status_message(), "name another folder"));
}

static bool weights_name_a_loss(const fixture *f, const char *run)
{
    char path[600];
    safetensors_file *file;
    snprintf(path, sizeof path, "%s/%s/weights.safetensors", f->root, run);
    if (safetensors_open(path, &file) != OK) fail_msg("%s", status_message());
    bool named = safetensors_metadata(file, "validation_loss") != NULL;
    safetensors_close(file);
    return named;
}

static void weights_without_validation_name_no_loss(void **state)
{
    const fixture *f = *state;
    write_config(f, 4, 2, 2, jitter);
    assert_int_equal(train(f, "validated", false, 0), OK);
    assert_true(weights_name_a_loss(f, "validated"));
    write_config(f, 4, 2, 0, jitter);
    assert_int_equal(train(f, "not", false, 0), OK);
    assert_false(weights_name_a_loss(f, "not"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(losses_fall_on_two_samples, set_up, tear_down),
        cmocka_unit_test_setup_teardown(albedo_weighs_what_the_configuration_says, set_up, tear_down),
        cmocka_unit_test_setup_teardown(both_lights_can_be_learned, set_up, tear_down),
        cmocka_unit_test_setup_teardown(charts_are_drawn_of_rows_with_fewer_losses, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_chart_that_cannot_be_drawn_does_not_end_training, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_curve_cut_within_its_header_begins_anew, set_up, tear_down),
        cmocka_unit_test_setup_teardown(weights_without_a_checkpoint_are_kept, set_up, tear_down),
        cmocka_unit_test_setup_teardown(more_held_back_than_there_are_is_refused, set_up, tear_down),
        cmocka_unit_test_setup_teardown(exported_weights_load_as_a_model, set_up, tear_down),
        cmocka_unit_test_setup_teardown(weights_that_a_run_starts_from_are_not_replaced, set_up, tear_down),
        cmocka_unit_test_setup_teardown(later_shared_weights_replace_earlier_ones, set_up, tear_down),
        cmocka_unit_test_setup_teardown(weights_without_validation_name_no_loss, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
