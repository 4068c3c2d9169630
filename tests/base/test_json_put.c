/* SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/json/json_put.h"
#include "base/status.h"
#include "each_allocation.h"

/* last, as cmocka defines a macro named fail */
#include <cmocka.h>

static cJSON *build(void)
{
    cJSON *root = cJSON_CreateObject();
    json_put_number(root, "gain", 2);
    json_put_bool(root, "known", true);
    json_put_text(root, "name", "caf\xe9");
    cJSON *lights = json_put_array(root, "lights");
    json_append(lights, cJSON_CreateNumber(1));
    json_append_text(lights, "lamp");
    json_put_number(json_append_object(lights), "power", 3);
    json_put_text(json_put_object(root, "lens"), "kind", "wide");
    json_put_item(root, "at", cJSON_CreateIntArray((const int[]){4, 5}, 2));
    return root;
}

static const char whole[] =
    "{\"gain\":2,\"known\":true,\"name\":\"caf\xef\xbf\xbd\",\"lights\":[1,\"lamp\",{\"power\":3}],"
    "\"lens\":{\"kind\":\"wide\"},\"at\":[4,5]}";

static void what_is_put_is_printed_in_its_order(void **state)
{
    (void)state;
    cJSON *root = build();
    char *line = json_print_line(root), *text = json_print(root);
    assert_string_equal(line, whole);
    cJSON *read = cJSON_Parse(text);
    assert_true(cJSON_Compare(read, root, true));
    cJSON_Delete(read);
    cJSON_Delete(root);
    free(line);
    free(text);
}

static int print(void *context)
{
    char **text = context;
    cJSON *root = build();
    *text = json_print_line(root);
    cJSON_Delete(root);
    return *text ? OK : (fail)(MERLIN_NO_MEMORY, "no memory");
}

static const char *check(void *context, int result)
{
    char **text = context;
    const char *fault = result == OK && strcmp(*text, whole) != 0 ? "JSON that lacks something" : NULL;
    free(*text);
    return fault;
}

static void json_that_memory_ran_out_for_has_no_text(void **state)
{
    (void)state;
    char *text = NULL;
    each_allocation_fails(&(memory_trial){"json", print, check, &text});
}

static void what_there_was_no_memory_for_is_missed_however_deep_it_is(void **state)
{
    (void)state;
    cJSON *root = cJSON_CreateObject();
    json_append(json_put_array(json_append_object(json_put_array(root, "a")), "b"), NULL);
    assert_null(json_print(root));
    assert_null(json_print_line(root));
    assert_null(json_print(NULL));
    cJSON_Delete(root);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_put_is_printed_in_its_order),
        cmocka_unit_test(json_that_memory_ran_out_for_has_no_text),
        cmocka_unit_test(what_there_was_no_memory_for_is_missed_however_deep_it_is),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
