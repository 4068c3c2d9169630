/* SPDX-License-Identifier: MIT */
#include "base/warnings.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static void a_warning_is_an_object_of_code_and_message(void **state)
{
    (void)state;
    warnings list = {0};
    warnings_add(&list, "burnt_out", "%.0f %% of the object is burnt out", 12.0);
    warnings_add(&list, "object_cut", "a name\nof \xff");
    cJSON *all = warnings_json(&list);
    char *text = cJSON_PrintUnformatted(all);
    assert_string_equal(text, "[{\"code\":\"burnt_out\",\"message\":\"12 % of the object is burnt out\"},"
                              "{\"code\":\"object_cut\",\"message\":\"a name?of \xef\xbf\xbd\"}]");
    assert_ptr_equal(warnings_find(&list, "object_cut"), &list.at[1]);
    assert_null(warnings_find(&list, "hollow"));
    free(text);
    cJSON_Delete(all);
}

static void no_warning_is_an_empty_array(void **state)
{
    (void)state;
    warnings list = {0};
    cJSON *all = warnings_json(&list);
    assert_true(cJSON_IsArray(all));
    assert_int_equal(cJSON_GetArraySize(all), 0);
    cJSON_Delete(all);
}

/* Captures what warnings_print writes, at most size - 1 bytes of it. */
static void printed(const warnings *list, size_t most, char *out, size_t size)
{
    FILE *aside = tmpfile();
    assert_non_null(aside);
    fflush(stderr);
    int kept = dup(STDERR_FILENO);
    assert_true(kept >= 0 && dup2(fileno(aside), STDERR_FILENO) >= 0);
    warnings_print(list, "estimate", "a\n.jpg", most);
    fflush(stderr);
    assert_true(dup2(kept, STDERR_FILENO) >= 0);
    close(kept);
    rewind(aside);
    out[fread(out, 1, size - 1, aside)] = 0;
    fclose(aside);
}

static void all_are_told_on_one_line_the_first_in_words(void **state)
{
    (void)state;
    char text[4096];
    warnings list = {0};
    printed(&list, 2, text, sizeof text);
    assert_string_equal(text, "");
    warnings_add(&list, "a", "one");
    printed(&list, 2, text, sizeof text);
    assert_string_equal(text, "merlin estimate: a?.jpg: one\n");
    warnings_add(&list, "b", "two");
    warnings_add(&list, "c", "three");
    warnings_add(&list, "d", "four");
    printed(&list, 2, text, sizeof text);
    assert_string_equal(text, "merlin estimate: a?.jpg: one; two; and 2 more, which --json names\n");
}

static void a_full_list_counts_what_it_has_no_room_for(void **state)
{
    (void)state;
    char text[WARNINGS_MOST * 32];
    warnings list = {0};
    for (int i = 0; i < WARNINGS_MOST + 3; i++)
        warnings_add(&list, "skipped", "file %d", i);
    assert_int_equal(list.count, WARNINGS_MOST);
    printed(&list, 1, text, sizeof text);
    char expected[96];
    snprintf(expected, sizeof expected, "merlin estimate: a?.jpg: file 0; and %d more, which --json names\n",
             WARNINGS_MOST + 2);
    assert_string_equal(text, expected);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_warning_is_an_object_of_code_and_message),
        cmocka_unit_test(no_warning_is_an_empty_array),
        cmocka_unit_test(all_are_told_on_one_line_the_first_in_words),
        cmocka_unit_test(a_full_list_counts_what_it_has_no_room_for),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
