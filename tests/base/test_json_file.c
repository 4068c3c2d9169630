/* SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/file.h"
#include "base/text/json_file.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "scratch.h"

static void put(const char *name, const char *text)
{
    if (file_write(scratch_path(name), text, strlen(text)) != OK) fail_msg("%s", status_message());
}

static json_object *reads(const char *name)
{
    json_object *o;
    if (json_file_read(scratch_path(name), "model", &o) != OK) fail_msg("%s", status_message());
    return o;
}

static int whole(json_object *o, const char *key)
{
    int value = 0;
    if (json_int(o, key, 0, 1000, &value) != OK) fail_msg("%s", status_message());
    return value;
}

/* Returns the object inside, which the caller frees. */
static json_object *inner(json_object *o, const char *key)
{
    char *text;
    json_object *in = NULL;
    if (json_inner(o, key, &text) != OK || json_parse(text, strlen(text), key, &in) != OK)
        fail_msg("%s", status_message());
    free(text);
    return in;
}

static void refuses(const char *name, const char *const *words)
{
    json_object *o;
    assert_int_equal(json_file_read(scratch_path(name), "model", &o), MERLIN_BAD_INPUT);
    assert_null(o);
    for (; *words; words++)
        if (!strstr(status_message(), *words)) fail_msg("\"%s\" does not say %s", status_message(), *words);
    assert_null(strchr(status_message(), '\n'));
}
#define REFUSES(name, ...) refuses(name, (const char *const[]){__VA_ARGS__, NULL})

static void objects_are_merged_and_arrays_replaced(void **unused)
{
    (void)unused;
    put("base.json", "{\"in\": {\"a\": 1, \"b\": 2, \"deep\": {\"x\": 1, \"y\": 2}}, \"list\": [1, 2, 3], \"c\": 3}");
    put("over.json", "{\"base\": \"base.json\", \"in\": {\"b\": 4, \"deep\": {\"y\": 5}}, \"list\": [6, 7], \"d\": 8}");
    json_object *o = reads("over.json"), *in = inner(o, "in"), *deep = inner(in, "deep");
    int list[2];
    assert_int_equal(json_ints(o, "list", 0, 9, 2, list), OK);
    assert_int_equal(list[0], 6);
    assert_int_equal(list[1], 7);
    assert_int_equal(whole(o, "c"), 3);
    assert_int_equal(whole(o, "d"), 8);
    assert_int_equal(whole(in, "a"), 1);
    assert_int_equal(whole(in, "b"), 4);
    assert_int_equal(whole(deep, "x"), 1);
    assert_int_equal(whole(deep, "y"), 5);
    assert_int_equal(json_finish(o), OK); /* "base" is not among the keys */
    json_free(deep);
    json_free(in);
    json_free(o);
}

static void paths_go_from_the_file_they_stand_in(void **unused)
{
    (void)unused;
    assert_int_equal(mkdir(scratch_path("models"), 0777), 0);
    assert_int_equal(mkdir(scratch_path("runs"), 0777), 0);
    put("models/wide.json", "{\"width\": 5, \"depth\": 6}");
    put("models/narrow.json", "{\"base\": \"wide.json\", \"width\": 4}");
    put("runs/1.json", "{\"model\": \"../models/narrow.json\", \"seed\": 1}");
    put("2.json", "{\"base\": \"runs/1.json\", \"seed\": 2}");
    json_object *o = reads("2.json"), *model = inner(o, "model");
    assert_int_equal(whole(o, "seed"), 2);
    assert_int_equal(whole(model, "width"), 4);
    assert_int_equal(whole(model, "depth"), 6);
    json_free(model);
    json_free(o);
    char text[600];
    snprintf(text, sizeof text, "{\"base\": \"%s\"}", scratch_path("runs/1.json"));
    put("models/3.json", text); /* an absolute path is used unchanged */
    o = reads("models/3.json");
    assert_int_equal(whole(o, "seed"), 1);
    json_free(o);
}

/* Otherwise a smaller network would keep the blocks of its base's larger one. */
static void a_named_model_has_nothing_of_the_bases_and_a_changed_one_has(void **unused)
{
    (void)unused;
    put("large.json", "{\"width\": 8, \"blocks\": 3}");
    put("small.json", "{\"width\": 2}");
    put("run.json", "{\"model\": \"large.json\"}");
    put("named.json", "{\"base\": \"run.json\", \"model\": \"small.json\"}");
    put("changed.json", "{\"base\": \"run.json\", \"model\": {\"width\": 2}}");
    json_object *named = reads("named.json"), *changed = reads("changed.json");
    json_object *small = inner(named, "model"), *large = inner(changed, "model");
    assert_int_equal(whole(small, "width"), 2);
    assert_false(json_has(small, "blocks"));
    assert_int_equal(whole(large, "width"), 2);
    assert_int_equal(whole(large, "blocks"), 3);
    json_free(small);
    json_free(large);
    json_free(named);
    json_free(changed);
}

static void a_missing_file_is_told_with_the_one_that_names_it(void **unused)
{
    (void)unused;
    put("run.json", "{\"base\": \"gone.json\"}");
    REFUSES("run.json", "run.json: \"base\"", "gone.json", "No such file");
    put("other.json", "{\"model\": \"gone.json\"}");
    REFUSES("other.json", "other.json: \"model\"", "gone.json", "No such file");
    REFUSES("nothing.json", "nothing.json", "No such file");
}

static void circles_are_refused(void **unused)
{
    (void)unused;
    put("self.json", "{\"base\": \"self.json\"}");
    REFUSES("self.json", "circle", "self.json");
    put("a.json", "{\"base\": \"b.json\"}");
    put("b.json", "{\"model\": \"a.json\"}");
    REFUSES("a.json", "b.json: \"model\" leads in a circle", "a.json");
}

static void eight_files_stand_on_one_another_and_no_nine(void **unused)
{
    (void)unused;
    put("1.json", "{\"seed\": 7}");
    for (int i = 2; i <= JSON_FILES_DEEP + 1; i++) {
        char name[24], text[48];
        snprintf(name, sizeof name, "%d.json", i);
        snprintf(text, sizeof text, "{\"base\": \"%d.json\"}", i - 1);
        put(name, text);
    }
    json_object *o = reads("8.json");
    assert_int_equal(whole(o, "seed"), 7);
    json_free(o);
    REFUSES("9.json", "2.json: \"base\"", "8 may be");
}

static void what_is_no_path_and_no_json_is_refused_by_its_file(void **unused)
{
    (void)unused;
    put("run.json", "{\"base\": 1}");
    REFUSES("run.json", "run.json: \"base\" must be the path of a file");
    put("run.json", "{\"base\": \"broken.json\"}");
    put("broken.json", "{\"seed\":");
    REFUSES("run.json", "broken.json is not JSON");
    put("broken.json", "[1]");
    REFUSES("run.json", "broken.json", "must be an object");
    put("broken.json", "{\"in\": {\"a\": 1, \"a\": 2}}");
    REFUSES("run.json", "broken.json: \"a\" is given twice");
    put("run.json", "{\"base\": \"\"}");
    REFUSES("run.json", "run.json: \"base\"");
}

static void messages_say_that_there_is_more_than_one_file(void **unused)
{
    (void)unused;
    put("run.json", "{\"base\": \"base.json\"}");
    put("base.json", "{\"seed\": 2000}");
    json_object *o = reads("run.json");
    int value;
    assert_int_equal(json_int(o, "seed", 0, 1000, &value), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "run.json with the files it names: \"seed\""));
    json_free(o);
    o = reads("base.json");
    assert_int_equal(json_int(o, "seed", 0, 1000, &value), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "base.json: \"seed\""));
    json_free(o);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        in_scratch(objects_are_merged_and_arrays_replaced),
        in_scratch(paths_go_from_the_file_they_stand_in),
        in_scratch(a_named_model_has_nothing_of_the_bases_and_a_changed_one_has),
        in_scratch(a_missing_file_is_told_with_the_one_that_names_it),
        in_scratch(circles_are_refused),
        in_scratch(eight_files_stand_on_one_another_and_no_nine),
        in_scratch(what_is_no_path_and_no_json_is_refused_by_its_file),
        in_scratch(messages_say_that_there_is_more_than_one_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
