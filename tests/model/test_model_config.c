/* SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/model.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static const char *const good =
    "{\"name\": \"m\", \"input_global\": true, \"material_decoders\": 1, \"feature_sharing\": true, "
    "\"gated_attention\": true, \"relight\": \"network\", \"global_illumination\": true, \"lighting\": \"point\", "
    "\"widths\": [32, 64, 96, 128, 192], \"gi_widths\": [16, 32, 48, 64, 96]}";

static status parse(const char *json, model_config *c)
{
    return model_config_parse(json, strlen(json), "test.json", c);
}

/* Returns `good` with one passage replaced, malloc'ed. */
static char *with(const char *from, const char *to)
{
    const char *at = strstr(good, from);
    assert_non_null(at);
    size_t size = strlen(good) + strlen(to) + 1;
    char *text = malloc(size);
    assert_non_null(text);
    snprintf(text, size, "%.*s%s%s", (int)(at - good), good, to, at + strlen(from));
    return text;
}

static void refuses(const char *from, const char *to, const char *word)
{
    model_config c;
    char *text = with(from, to);
    assert_int_equal(parse(text, &c), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "test.json"));
    if (!strstr(status_message(), word)) fail_msg("\"%s\" does not name %s", status_message(), word);
    free(text);
}

static void configuration_survives_writing_and_reading(void **unused)
{
    (void)unused;
    model_config a, b;
    assert_int_equal(parse(good, &a), OK);
    assert_int_equal(a.widths[4], 192);
    assert_int_equal(a.gi_widths[0], 16);
    assert_int_equal(a.relight, MODEL_RELIGHT_NETWORK);
    char *text = model_config_write(&a);
    assert_non_null(text);
    assert_int_equal(parse(text, &b), OK);
    assert_memory_equal(&a, &b, sizeof a);
    free(text);
}

static void blocks_may_be_left_out(void **unused)
{
    (void)unused;
    model_config a, b;
    assert_int_equal(parse(good, &a), OK);
    char *given = with("96]}", "96], \"encoder_blocks\": [0, 1, 2, 3, 4], \"material_blocks\": [5, 6, 7, 8]}");
    assert_int_equal(parse(given, &b), OK);
    free(given);
    for (int i = 0; i < MODEL_LEVELS; i++) {
        assert_int_equal(a.encoder_blocks[i], 0);
        assert_int_equal(b.encoder_blocks[i], i);
    }
    for (int i = 0; i < MODEL_LEVELS - 1; i++) {
        assert_int_equal(a.material_blocks[i], 0);
        assert_int_equal(b.material_blocks[i], 5 + i);
    }
    char *text = model_config_write(&b);
    assert_non_null(text);
    assert_int_equal(parse(text, &a), OK);
    assert_memory_equal(&a, &b, sizeof a);
    free(text);
}

static void wrong_configurations_are_refused_by_key(void **unused)
{
    (void)unused;
    refuses("\"name\": \"m\"", "\"name\": \"m\", \"naem\": 1", "naem");
    refuses("\"input_global\": true, ", "", "input_global");
    refuses("\"gated_attention\": true", "\"gated_attention\": 1", "gated_attention");
    refuses("\"material_decoders\": 1", "\"material_decoders\": 2", "material_decoders");
    refuses("\"material_decoders\": 1", "\"material_decoders\": 1.5", "material_decoders");
    refuses("\"material_decoders\": 1", "\"material_decoders\": \"1\"", "material_decoders");
    refuses("\"network\"", "\"magic\"", "brdf");
    refuses("\"network\"", "\"brdf\"", "feature_sharing");
    refuses("\"name\": \"m\"", "\"name\": \"m\", \"name\": \"n\"", "twice");
    refuses("[32, 64", "[33, 64", "widths");
    refuses("[32, 64", "[-32, 64", "widths");
    refuses("[32, 64", "[64", "widths");
    refuses("[32, 64", "[1e30, 64", "widths");
    refuses("96]}", "96], \"encoder_blocks\": [0, 0, 0, 0, -1]}", "encoder_blocks");
    refuses("96]}", "96], \"material_blocks\": [0, 0, 0, 0, 0]}", "material_blocks");
    refuses("96]}", "96], \"material_blocks\": 1}", "material_blocks");
    refuses("\"name\": \"m\"", "\"name\": \"\"", "name");
    refuses("\"name\": \"m\"", "\"name\": \"a b\"", "name");
}

static void text_that_is_not_one_object_is_refused(void **unused)
{
    (void)unused;
    model_config c;
    assert_int_equal(parse("", &c), MERLIN_BAD_INPUT);
    assert_int_equal(parse("[1]", &c), MERLIN_BAD_INPUT);
    assert_int_equal(parse("{\"name\": ", &c), MERLIN_BAD_INPUT);
    char *text = with("96]}", "96]} {}");
    assert_int_equal(parse(text, &c), MERLIN_BAD_INPUT);
    free(text);
    assert_int_equal(model_config_read("/nonexistent/x.json", &c), MERLIN_BAD_INPUT);
}

static void light_code_has_3_or_30_values(void **unused)
{
    (void)unused;
    model_config c;
    assert_int_equal(parse(good, &c), OK);
    assert_int_equal(model_light_size(&c), 3);
    char *text = with("\"lighting\": \"point\"", "\"lighting\": \"both\"");
    assert_int_equal(parse(text, &c), OK);
    free(text);
    assert_int_equal(model_light_size(&c), 30);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(configuration_survives_writing_and_reading),
        cmocka_unit_test(blocks_may_be_left_out),
        cmocka_unit_test(wrong_configurations_are_refused_by_key),
        cmocka_unit_test(text_that_is_not_one_object_is_refused),
        cmocka_unit_test(light_code_has_3_or_30_values),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
