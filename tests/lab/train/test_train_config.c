/* SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lab/train/config/train_config.h"
#include "nn/device.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

/* Returns a run of configs/ as one text, malloc'ed. */
static char *shipped(void)
{
    model_config m;
    train_config t;
    if (train_config_read(MERLIN_SOURCE_DIR "/configs/runs/merlin-point/01-128.json", &m, &t) != OK)
        fail_msg("%s", status_message());
    char *model = model_config_write(&m), *training = train_config_write(&t), *text = NULL;
    if (!model || !training || asprintf(&text, "{\"model\": %s, \"training\": %s}", model, training) < 0)
        fail_msg("no memory");
    free(model);
    free(training);
    return text;
}

static void refuses(const char *from, const char *to, const char *word)
{
    model_config m;
    train_config t;
    char *good = shipped();
    const char *at = strstr(good, from);
    assert_non_null(at);
    size_t size = strlen(good) + strlen(to) + 1;
    char *text = malloc(size);
    assert_non_null(text);
    snprintf(text, size, "%.*s%s%s", (int)(at - good), good, to, at + strlen(from));
    assert_int_equal(train_config_parse(text, strlen(text), "test.json", &m, &t), MERLIN_BAD_INPUT);
    if (!strstr(status_message(), word)) fail_msg("\"%s\" does not name %s", status_message(), word);
    free(text);
    free(good);
}

static void shipped_configuration_survives_writing_and_reading(void **unused)
{
    (void)unused;
    model_config m, m2;
    train_config t, t2;
    char *good = shipped();
    assert_int_equal(train_config_parse(good, strlen(good), "test.json", &m, &t), OK);
    assert_int_equal(t.size, 128);
    assert_int_equal(t.type, NN_BFLOAT16);
    char *model = model_config_write(&m), *training = train_config_write(&t), again[8192];
    snprintf(again, sizeof again, "{\"training\": %s, \"model\": %s}", training, model);
    assert_int_equal(train_config_parse(again, strlen(again), "again.json", &m2, &t2), OK);
    assert_memory_equal(&m, &m2, sizeof m);
    assert_memory_equal(&t, &t2, sizeof t);
    free(model);
    free(training);
    free(good);
}

static void a_network_alone_is_no_run(void **unused)
{
    (void)unused;
    model_config m;
    train_config t;
    assert_int_equal(train_config_read(MERLIN_SOURCE_DIR "/configs/models/merlin-point.json", &m, &t),
                     MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "describes a network"));
}

static void wrong_configurations_are_refused_by_key(void **unused)
{
    (void)unused;
    refuses("\"size\": 128", "\"size\": 100", "size");
    refuses("\"size\": 128", "\"siez\": 128", "size");
    refuses("\"batch\": 16", "\"batch\": 0", "batch");
    refuses("\"batch\": 16", "\"batch\": \"16\"", "batch");
    refuses("\"size\": 128, \"batch\": 16", "\"size\": 32, \"batch\": 1", "2 at least");
    refuses("\"batch\": 16", "\"batch\": 15", "validation_count");
    refuses("\"batch\": 16", "\"batch\": 16, \"bacth\": 16", "bacth");
    refuses("\"presentations\": 192000", "\"presentations\": 1e12", "presentations");
    refuses("\"bf16\"", "\"f16\"", "type");
    refuses("\"training\":", "\"trianing\":", "training");
    refuses("\"model\":", "\"extra\": {}, \"model\":", "extra");
    refuses("\"seed\": 1,", "", "seed");
    refuses("\"seed\": 1,", "\"seed\": 1, \"jpeg\": 1.5,", "jpeg");
    refuses("\"seed\": 1,", "\"seed\": 1, \"camera_turn\": true,", "camera_turn");
    refuses("\"seed\": 1,", "\"seed\": 1, \"flash_in_room\": 0.4, \"lamp_alone\": 0.2,", "five sixths");
    refuses("\"seed\": 1,", "\"seed\": 1, \"jpeg\": 0.5, \"jpeg\": 0.5,", "jpeg");
}

/* Checkpoints contain their configuration as text: those written before these keys existed must still match. */
static void faults_left_out_are_none_and_stay_left_out(void **unused)
{
    (void)unused;
    static const char *const keys[] = {
        "camera_turn",   "distance_jitter", "background_leak",     "outline_error", "jpeg",         "perfect_camera",
        "average_decay", "weight_decay",    "relight_brdf_weight", "dark_target",   "albedo_weight"};
    model_config m;
    train_config t, again;
    char *good = shipped();
    assert_int_equal(train_config_parse(good, strlen(good), "test.json", &m, &t), OK);
    char *training = train_config_write(&t), *model = model_config_write(&m), text[8192];
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        assert_null(strstr(training, keys[i]));
    assert_float_equal(t.albedo_weight, 1, 0);
    free(training);
    t.albedo_weight = 0;
    t.camera_turn = 5;
    t.distance_jitter = 0.25;
    t.background_leak = 0.5;
    t.outline_error = 0.125;
    t.jpeg = 0.75;
    t.perfect_camera = 0.375;
    t.average_decay = 0.9375;
    t.weight_decay = 0.03125;
    t.relight_brdf_weight = 2;
    t.dark_target = 0.0625;
    training = train_config_write(&t);
    snprintf(text, sizeof text, "{\"training\": %s, \"model\": %s}", training, model);
    assert_int_equal(train_config_parse(text, strlen(text), "again.json", &m, &again), OK);
    assert_memory_equal(&t, &again, sizeof t);
    free(training);
    free(model);
    free(good);
}

static void the_faster_type_can_be_asked_for(void **unused)
{
    (void)unused;
    model_config m;
    train_config t;
    char *good = shipped(), *at = strstr(good, "\"bf16\"");
    assert_non_null(at);
    memcpy(at, "\"auto\"", 6);
    assert_int_equal(train_config_parse(good, strlen(good), "test.json", &m, &t), OK);
    assert_int_equal(t.type, nn_fastest_type());
    assert_int_equal(cpu_device()->usable_type(t.type), t.type);
    free(good);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shipped_configuration_survives_writing_and_reading),
        cmocka_unit_test(a_network_alone_is_no_run),
        cmocka_unit_test(wrong_configurations_are_refused_by_key),
        cmocka_unit_test(faults_left_out_are_none_and_stay_left_out),
        cmocka_unit_test(the_faster_type_can_be_asked_for),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
