/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"
#include "lab/train/curves.h"
#include "lab/train/train.h"
#include "model/model.h"
#include "nn/safetensors.h"

/* cmocka names a macro fail, so that it comes behind base/status.h */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "scratch.h"
#include "synthetic.h"

enum { SIZE = 64, SAMPLES = 6 };

typedef struct fixture {
    char *data, *root, config[4200];
} fixture;

static const char *const jitter = "\"exposure_jitter\": 0.2, \"colour_jitter\": 0.05";
static const char *const no_jitter = "\"exposure_jitter\": 0, \"colour_jitter\": 0";

typedef struct experiment {
    int presentations, batch, validation;
    const char *lighting, *more;
    int minutes; /* between checkpoints */
} experiment;

/* A model of a few thousand parameters. */
static void write_experiment(const fixture *f, const experiment *e)
{
    char text[2048];
    int n =
        snprintf(text, sizeof text,
                 "{\"model\": {\"name\": \"tiny\", \"input_global\": true, \"material_decoders\": 1, "
                 "\"feature_sharing\": true, \"gated_attention\": true, \"relight\": \"network\", "
                 "\"global_illumination\": true, \"lighting\": \"%s\", \"widths\": [16, 16, 16, 16, 16], "
                 "\"gi_widths\": [8, 8, 8, 8, 8]}, \"training\": {\"size\": %d, \"batch\": %d, \"presentations\": %d, "
                 "\"learning_rate\": 3e-3, \"encoder_rate_scale\": 1, \"halve_every_epochs\": 30, "
                 "\"warmup_steps\": 2, \"beta1\": 0.9, \"beta2\": 0.99, \"clip_norm\": 5, \"depth_weight\": 2, "
                 "\"type\": \"f32\", "
                 "\"seed\": 1, %s, \"memory_gib\": 1, \"validation_count\": %d, "
                 "\"validation_steps\": 2, \"curve_steps\": 4, \"checkpoint_minutes\": %d}}",
                 e->lighting, SIZE, e->batch, e->presentations, e->more, e->validation, e->minutes);
    if (file_write(f->config, text, (size_t)n) != OK) fail_msg("%s", status_message());
}

static void write_config(const fixture *f, int presentations, int batch, int validation, const char *more)
{
    write_experiment(f, &(experiment){presentations, batch, validation, "point", more, 100});
}

static int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    assert_non_null(f);
    f->data = scratch_new();
    f->root = scratch_new();
    snprintf(f->config, sizeof f->config, "%s/tiny.json", f->root);
    for (int i = 0; i < SAMPLES; i++)
        sphere_write(f->data, SIZE, i);
    *state = f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    scratch_remove(f->data);
    scratch_remove(f->root);
    free(f);
    return 0;
}

static int steps_left;

static int stop_after_steps(void)
{
    return --steps_left <= 0;
}

/* begins: what the run begins from. */
static status train_beginning(const fixture *f, const char *name, trn_options begins)
{
    char *output = file_join(f->root, name);
    begins.config = f->config;
    begins.data = f->data;
    begins.output = output;
    begins.quiet = true;
    status s = trn_train(&begins);
    free(output);
    return s;
}

static status train_from(const fixture *f, const char *name, const char *weights)
{
    return train_beginning(f, name, (trn_options){.init = weights});
}

static status train_from_shared(const fixture *f, const char *name, const char *const *weights)
{
    return train_beginning(f, name, (trn_options){.init_shared = weights});
}

static status train_asked(const fixture *f, const char *name, bool resume, int (*interrupted)(void))
{
    char *output = file_join(f->root, name);
    trn_options o = {.config = f->config,
                     .data = f->data,
                     .output = output,
                     .resume = resume,
                     .quiet = true,
                     .interrupted = interrupted};
    status s = trn_train(&o);
    free(output);
    return s;
}

static status train(const fixture *f, const char *name, bool resume, int stop_after)
{
    steps_left = stop_after;
    return train_asked(f, name, resume, stop_after ? stop_after_steps : NULL);
}

static char *contents(const fixture *f, const char *run, const char *name, size_t *size)
{
    char path[600], *data;
    snprintf(path, sizeof path, "%s/%s/%s", f->root, run, name);
    if (file_read(path, 1 << 28, &data, size) != OK) fail_msg("%s", status_message());
    return data;
}

static void same_file(const fixture *f, const char *a, const char *b, const char *name)
{
    size_t size_a, size_b;
    char *data_a = contents(f, a, name, &size_a), *data_b = contents(f, b, name, &size_b);
    assert_int_equal(size_a, size_b);
    assert_memory_equal(data_a, data_b, size_a);
    free(data_a);
    free(data_b);
}

/* Parameters, running statistics and both moments; the weights; the curves. */
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
    resume_and_compare(*state, "both", jitter);
}

static void resumed_training_on_faulty_photographs_is_bit_identical(void **state)
{
    resume_and_compare(*state, "both",
                       "\"exposure_jitter\": 0.2, \"colour_jitter\": 0.05, \"camera_turn\": 10, "
                       "\"distance_jitter\": 0.3, \"background_leak\": 0.5, \"outline_error\": 0.5, \"jpeg\": 0.5");
}

/* Long enough for the mean to have moved before the run stops and after. */
static void resumed_training_with_a_mean_of_the_weights_is_bit_identical(void **state)
{
    const fixture *f = *state;
    write_config(f, 34, 2, 2, "\"exposure_jitter\": 0.2, \"colour_jitter\": 0.05, \"average_decay\": 0.9");
    if (train(f, "a", false, 0) != OK) fail_msg("%s", status_message());
    assert_int_equal(train(f, "b", false, 9), MERLIN_STOPPED);
    if (train(f, "b", true, 0) != OK) fail_msg("%s", status_message());
    same_run(f, "a", "b");
}

/* A run killed outright leaves rows behind its last checkpoint. */
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

/* Nothing can be written to a file from the second step on. */
static int block_after_two_steps(void)
{
    if (--steps_left) return 0;
    assert_int_equal(rename(blocked, aside), 0);
    assert_int_equal(file_make_folder(blocked), OK);
    return 0;
}

/* What the last step leaves to do is done on resume, wherever the run ended: three steps, a checkpoint at each. */
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

/* Of curves.csv. */
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

/* A column of curves.csv (0: step) ends below this share of where it began: the first row is the mean of the first four
 * steps. */
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

/* Of the first row of curves.csv: the sum of all losses less what it should be of the losses beside it. */
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
    assert_int_equal(trn_curve_chart(csv, "/nonexistent", png), OK);
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
    assert_int_equal(trn_curve_truncate(csv, 4), OK);
    assert_int_equal(trn_curve_append(csv, &(trn_curve_row){.step = 5}, &(trn_losses){.count = 1}), OK);
    assert_int_equal(trn_curve_append(csv, &(trn_curve_row){.step = 6}, &(trn_losses){.count = 1}), OK);
    assert_int_equal(file_read(csv, 1 << 12, &text, &size), OK);
    assert_int_equal(strncmp(text, "step,presentations,", 19), 0);
    assert_null(strstr(text + 1, "step,"));
    assert_non_null(strstr(text, "\n5,"));
    assert_non_null(strstr(text, "\n6,"));
    free(text);
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

/* Writes the checkpoint anew with another value of one of its words. */
static void falsify_checkpoint(const char *path, const char *key, const char *value)
{
    static const char *const KEYS[] = {"checkpoint", "config", "training",   "samples",
                                       "counters",   "best",   "open_losses"};
    enum { COUNT = sizeof KEYS / sizeof *KEYS };
    const char *metadata[COUNT][2];
    st_file *file;
    assert_int_equal(st_open(path, &file), OK);
    for (size_t i = 0; i < COUNT; i++) {
        metadata[i][0] = KEYS[i];
        metadata[i][1] = strcmp(KEYS[i], key) == 0 ? value : st_metadata(file, KEYS[i]);
    }
    st_tensor *tensors = calloc(st_count(file), sizeof *tensors);
    assert_non_null(tensors);
    for (size_t i = 0; i < st_count(file); i++)
        tensors[i] = *st_at(file, i);
    assert_int_equal(st_write(path, tensors, st_count(file), (const char *const(*)[2])metadata, COUNT), OK);
    free(tensors);
    st_close(file);
}

/* Steps times a batch must stay a number. */
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

/* How much memory samples may take and how often a checkpoint is written change nothing that comes of a run. */
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

/* The one configuration as three files: its model, another training, and what makes that this one. */
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

/* A checkpoint belongs to the run that was trained, wherever that was written. */
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
    assert_false(file_exists(output)); /* nor is a folder left behind */
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
    st_file *file;
    snprintf(path, sizeof path, "%s/%s/weights.safetensors", f->root, run);
    if (st_open(path, &file) != OK) fail_msg("%s", status_message());
    bool named = st_metadata(file, "validation_loss") != NULL;
    st_close(file);
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
        cmocka_unit_test_setup_teardown(resumed_training_is_bit_identical, set_up, tear_down),
        cmocka_unit_test_setup_teardown(rows_behind_the_checkpoint_are_dropped_on_resume, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_last_validation_that_failed_is_made_on_resume, set_up, tear_down),
        cmocka_unit_test_setup_teardown(last_weights_that_were_not_written_are_on_resume, set_up, tear_down),
        cmocka_unit_test_setup_teardown(losses_fall_on_two_samples, set_up, tear_down),
        cmocka_unit_test_setup_teardown(albedo_weighs_what_the_configuration_says, set_up, tear_down),
        cmocka_unit_test_setup_teardown(both_lights_can_be_learned, set_up, tear_down),
        cmocka_unit_test_setup_teardown(resumed_training_of_both_lights_is_bit_identical, set_up, tear_down),
        cmocka_unit_test_setup_teardown(resumed_training_with_a_mean_of_the_weights_is_bit_identical, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(resumed_training_on_faulty_photographs_is_bit_identical, set_up, tear_down),
        cmocka_unit_test_setup_teardown(charts_are_drawn_of_rows_with_fewer_losses, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_chart_that_cannot_be_drawn_does_not_end_training, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_curve_cut_within_its_header_begins_anew, set_up, tear_down),
        cmocka_unit_test_setup_teardown(run_is_not_overwritten_without_resume, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_run_goes_on_with_less_memory, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_run_goes_on_by_a_configuration_in_parts, set_up, tear_down),
        cmocka_unit_test_setup_teardown(weights_without_a_checkpoint_are_kept, set_up, tear_down),
        cmocka_unit_test_setup_teardown(checkpoint_of_another_configuration_is_refused, set_up, tear_down),
        cmocka_unit_test_setup_teardown(checkpoint_of_impossible_counts_is_refused, set_up, tear_down),
        cmocka_unit_test_setup_teardown(more_held_back_than_there_are_is_refused, set_up, tear_down),
        cmocka_unit_test_setup_teardown(exported_weights_load_as_a_model, set_up, tear_down),
        cmocka_unit_test_setup_teardown(weights_that_a_run_starts_from_are_not_replaced, set_up, tear_down),
        cmocka_unit_test_setup_teardown(later_shared_weights_replace_earlier_ones, set_up, tear_down),
        cmocka_unit_test_setup_teardown(weights_without_validation_name_no_loss, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
