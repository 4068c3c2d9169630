/* SPDX-License-Identifier: MIT */
/* Lists of skipped files. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/skipped.h"

#include <cmocka.h>

static void add(skipped_files *list, const char *name, const char *why)
{
    assert_int_equal(skipped_add(list, name, why), OK);
}

static void files_are_counted_and_named_by_reason(void **state)
{
    (void)state;
    skipped_files list = {0};
    char words[512];
    skipped_words(&list, words, sizeof words);
    assert_string_equal(words, "");
    add(&list, "a.jxl", "JPEG XL is not read");
    skipped_words(&list, words, sizeof words);
    assert_string_equal(words, "1 file skipped: a.jxl (JPEG XL is not read)");
    add(&list, "b.txt", "no picture");
    add(&list, "c.jxl", "JPEG XL is not read");
    skipped_words(&list, words, sizeof words);
    assert_string_equal(words, "3 files skipped: a.jxl, c.jxl (JPEG XL is not read), b.txt (no picture)");
    skipped_free(&list);
}

static void names_without_room_are_counted(void **state)
{
    (void)state;
    skipped_files list = {0};
    for (int i = 0; i < 1000; i++) {
        char name[16];
        snprintf(name, sizeof name, "%03d.txt", i);
        add(&list, name, i % 2 ? "no picture" : "a copy");
    }
    for (size_t size = 65; size < 600; size++) {
        char words[600];
        memset(words, '!', sizeof words);
        skipped_words(&list, words, size);
        size_t length = strlen(words), named = 0;
        assert_true(length < size);
        assert_int_equal(words[size], '!');
        for (const char *c = words; (c = strstr(c, ".txt")); c++)
            named++;
        const char *more = strstr(words, named ? " and " : "skipped: ");
        assert_non_null(more);
        assert_int_equal(strtol(more + (named ? 5 : 9), NULL, 10), 1000 - named);
    }
    skipped_free(&list);
}

static void a_report_names_all_of_them(void **state)
{
    (void)state;
    skipped_files list = {0}, more = {0};
    add(&list, "a\xff.jxl", "JPEG XL is not read");
    add(&more, "b", "no picture");
    assert_int_equal(skipped_append(&list, &more), OK);
    assert_int_equal(more.count, 0);
    cJSON *all = cJSON_CreateArray();
    skipped_json(&list, "box", all);
    char *text = cJSON_PrintUnformatted(all);
    assert_string_equal(text, "[{\"file\":\"box/a\xef\xbf\xbd.jxl\",\"why\":\"JPEG XL is not read\"},"
                              "{\"file\":\"box/b\",\"why\":\"no picture\"}]");
    free(text);
    cJSON_Delete(all);
    warnings out = {0};
    skipped_warn(&list, &out);
    assert_string_equal(out.at[0].code, "files_skipped");
    skipped_free(&list);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_are_counted_and_named_by_reason),
        cmocka_unit_test(names_without_room_are_counted),
        cmocka_unit_test(a_report_names_all_of_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
