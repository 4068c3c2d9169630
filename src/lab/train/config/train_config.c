/* SPDX-License-Identifier: MIT */
#include "lab/train/config/train_config.h"

#include <limits.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text/json_file.h"

static const char *const type_words[] = {"f32", "bf16", "auto"};

static status read_rates(json_object *o, train_config *c)
{
    status s = json_number(o, "learning_rate", 1e-9, 1, &c->learning_rate);
    if (s == OK) s = json_number(o, "encoder_rate_scale", 0, 10, &c->encoder_rate_scale);
    if (s == OK) s = json_number(o, "halve_every_epochs", 0, 1e6, &c->halve_every_epochs);
    if (s == OK) s = json_int(o, "warmup_steps", 0, 1000000, &c->warmup_steps);
    if (s == OK) s = json_number(o, "beta1", 0, 0.9999, &c->beta1);
    if (s == OK) s = json_number(o, "beta2", 0, 0.999999, &c->beta2);
    if (s == OK) s = json_number(o, "clip_norm", 0, 1e6, &c->clip_norm);
    if (s == OK) s = json_number(o, "depth_weight", 0, 1e4, &c->depth_weight);
    return s;
}

/* An optional key. */
typedef struct optional {
    const char *key;
    double high;
    size_t offset; /* offset in train_config */
    double left_out;
} optional;

static const optional optionals[] = {
    {"albedo_weight", 1e4, offsetof(train_config, albedo_weight), 1},
    {"camera_turn", 20, offsetof(train_config, camera_turn), 0},
    {"distance_jitter", 0.7, offsetof(train_config, distance_jitter), 0},
    {"background_leak", 1, offsetof(train_config, background_leak), 0},
    {"outline_error", 1, offsetof(train_config, outline_error), 0},
    {"jpeg", 1, offsetof(train_config, jpeg), 0},
    {"perfect_camera", 1, offsetof(train_config, perfect_camera), 0},
    {"relight_brdf_weight", 1e4, offsetof(train_config, relight_brdf_weight), 0},
    {"ssim_weight", 1e4, offsetof(train_config, ssim_weight), 0},
    {"dark_target", 1, offsetof(train_config, dark_target), 0},
    {"fewest_pictures", 64, offsetof(train_config, fewest_pictures), 1},
    {"most_pictures", 64, offsetof(train_config, most_pictures), 1},
    {"single_rate_scale", 10, offsetof(train_config, single_rate_scale), 1},
    {"lamp_weight", 1e4, offsetof(train_config, lamp_weight), 0.25},
    {"flash_alone", 1, offsetof(train_config, flash_alone), 1.0 / 3},
    {"flash_in_room", 1, offsetof(train_config, flash_in_room), 0},
    {"lamp_alone", 1, offsetof(train_config, lamp_alone), 0},
    {"weight_decay", 1, offsetof(train_config, weight_decay), 0},
    {"average_decay", 0.999999, offsetof(train_config, average_decay), 0},
};
enum { OPTIONALS = sizeof optionals / sizeof *optionals };

static status read_optionals(json_object *o, train_config *c)
{
    status s = OK;
    for (int i = 0; i < OPTIONALS && s == OK; i++) {
        double value = 0;
        s = json_number_or(o, optionals[i].key, 0, optionals[i].high, optionals[i].left_out, &value);
        memcpy((char *)c + optionals[i].offset, &value, sizeof value);
    }
    return s;
}

/* A sixth of the photographs is by the surroundings alone (train/samples/mixture.h). */
static status check_kinds(const char *where, const train_config *c)
{
    if (c->flash_alone + c->flash_in_room + c->lamp_alone <= 5.0 / 6) return OK;
    return fail(MERLIN_BAD_INPUT,
                "%s: \"flash_alone\", \"flash_in_room\" and \"lamp_alone\" must not make more than five sixths of the "
                "photographs",
                where);
}

static status check_pictures(const char *where, const train_config *c)
{
    const double few = c->fewest_pictures, most = c->most_pictures;
    if (few != (int)few || most != (int)most || few < 1)
        return fail(MERLIN_BAD_INPUT, "%s: \"fewest_pictures\" and \"most_pictures\" must be whole numbers from 1 on",
                    where);
    if (few <= most) return OK;
    return fail(MERLIN_BAD_INPUT, "%s: \"fewest_pictures\" must not be more than \"most_pictures\"", where);
}

/* Writes the optional keys that differ from their defaults, each after a comma and a space. */
static void write_optionals(const train_config *c, char *out, size_t size)
{
    size_t length = 0;
    out[0] = 0;
    for (int i = 0; i < OPTIONALS; i++) {
        double value;
        memcpy(&value, (const char *)c + optionals[i].offset, sizeof value);
        if (value != optionals[i].left_out)
            length += (size_t)snprintf(out + length, size - length, ", \"%s\": %.9g", optionals[i].key, value);
    }
}

static status read_intervals(json_object *o, train_config *c)
{
    status s = json_int(o, "validation_count", 0, INT_MAX, &c->validation_count);
    if (s == OK) s = json_int(o, "validation_steps", 0, INT_MAX, &c->validation_steps);
    if (s == OK) s = json_int(o, "curve_steps", 1, 1000000, &c->curve_steps);
    if (s == OK) s = json_number(o, "checkpoint_minutes", 0, 1e4, &c->checkpoint_minutes);
    return s;
}

static status read_training(json_object *o, const char *where, train_config *c)
{
    int type = 0;
    status s = json_int(o, "size", MODEL_SIZE_MULTIPLE, 4096, &c->size);
    if (s == OK && c->size % MODEL_SIZE_MULTIPLE)
        s = fail(MERLIN_BAD_INPUT, "%s: \"size\" must be a multiple of %d", where, MODEL_SIZE_MULTIPLE);
    if (s == OK) s = json_int(o, "batch", 1, 1024, &c->batch);
    if (s == OK && c->size == MODEL_SIZE_MULTIPLE && c->batch == 1) /* a batch of one pixel has no variance */
        s = fail(MERLIN_BAD_INPUT, "%s: \"batch\" must be 2 at least where \"size\" is %d", where, MODEL_SIZE_MULTIPLE);
    if (s == OK) s = json_int(o, "presentations", 1, INT_MAX, &c->presentations);
    if (s == OK) s = read_rates(o, c);
    if (s == OK) s = json_choice(o, "type", type_words, 3, &type);
    if (s == OK) s = json_int(o, "seed", 0, INT_MAX, &c->seed);
    if (s == OK) s = json_number(o, "exposure_jitter", 0, 2, &c->exposure_jitter);
    if (s == OK) s = json_number(o, "colour_jitter", 0, 1, &c->colour_jitter);
    if (s == OK) s = read_optionals(o, c);
    if (s == OK) s = check_pictures(where, c);
    if (s == OK) s = check_kinds(where, c);
    if (s == OK) s = json_number(o, "memory_gib", 0, 1e5, &c->memory_gib);
    if (s == OK) s = read_intervals(o, c);
    if (s == OK && c->validation_count % c->batch)
        s = fail(MERLIN_BAD_INPUT, "%s: \"validation_count\" must be a multiple of \"batch\"", where);
    c->type = type == 2 ? nn_fastest_type() : type == 1 ? NN_BFLOAT16 : NN_FLOAT32;
    return s == OK ? json_finish(o) : s;
}

static status parse_training(const char *json, const char *where, train_config *c)
{
    json_object *o;
    status s = json_parse(json, strlen(json), where, &o);
    if (s != OK) return s;
    s = read_training(o, where, c);
    json_free(o);
    return s;
}

static status parse_parts(json_object *o, model_config *model, train_config *training)
{
    const char *where = json_where(o);
    char *model_json = NULL, *training_json = NULL;
    if (json_has(o, "name") && !json_has(o, "model"))
        return fail(MERLIN_BAD_INPUT, "%s describes a network; what is trained is a file that has it as its \"model\"",
                    where);
    status s = json_inner(o, "model", &model_json);
    if (s == OK) s = json_inner(o, "training", &training_json);
    if (s == OK) s = json_finish(o);
    if (s == OK) s = model_config_parse(model_json, strlen(model_json), where, model);
    if (s == OK) s = parse_training(training_json, where, training);
    if (s == OK && training->relight_brdf_weight > 0 && model->relight != MODEL_RELIGHT_NETWORK)
        s = fail(MERLIN_BAD_INPUT, "%s: \"relight_brdf_weight\" needs \"relight\": \"network\"", where);
    free(model_json);
    free(training_json);
    return s;
}

/* Parses the objects after a reader that returned s and o. */
static status parse_read(status s, json_object *o, model_config *model, train_config *training)
{
    memset(model, 0, sizeof *model);
    memset(training, 0, sizeof *training);
    if (s == OK) s = parse_parts(o, model, training);
    json_free(o);
    return s;
}

status train_config_parse(const char *json, size_t size, const char *where, model_config *model, train_config *training)
{
    json_object *o;
    status s = json_parse(json, size, where, &o);
    return parse_read(s, o, model, training);
}

status train_config_read(const char *path, model_config *model, train_config *training)
{
    json_object *o;
    status s = json_file_read(path, "model", &o);
    return parse_read(s, o, model, training);
}

char *train_config_write(const train_config *c)
{
    char *text = NULL, more[OPTIONALS * 40];
    write_optionals(c, more, sizeof more);
    int length = asprintf(
        &text,
        "{\"size\": %d, \"batch\": %d, \"presentations\": %d, \"learning_rate\": %.9g, \"encoder_rate_scale\": %.9g, "
        "\"halve_every_epochs\": %.9g, \"warmup_steps\": %d, \"beta1\": %.9g, \"beta2\": %.9g, \"clip_norm\": %.9g, "
        "\"depth_weight\": %.9g, \"type\": \"%s\", \"seed\": %d, \"exposure_jitter\": %.9g, \"colour_jitter\": %.9g, "
        "\"memory_gib\": %.9g, "
        "\"validation_count\": %d, \"validation_steps\": %d, \"curve_steps\": %d, \"checkpoint_minutes\": %.9g%s}",
        c->size, c->batch, c->presentations, c->learning_rate, c->encoder_rate_scale, c->halve_every_epochs,
        c->warmup_steps, c->beta1, c->beta2, c->clip_norm, c->depth_weight, type_words[c->type == NN_BFLOAT16], c->seed,
        c->exposure_jitter, c->colour_jitter, c->memory_gib, c->validation_count, c->validation_steps, c->curve_steps,
        c->checkpoint_minutes, more);
    return length < 0 ? NULL : text;
}
