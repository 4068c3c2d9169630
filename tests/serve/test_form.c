/* SPDX-License-Identifier: MIT */
/* Forms that clients send, and how they are read. */
#include <stdio.h>
#include <string.h>

#include "base/file.h"
#include "serve/jobs/form.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static void names_become_plain_ones(void **state)
{
    static const char *const names[][2] = {
        {"cup.jpg", "cup.jpg"},
        {"../../etc/passwd", "passwd"},
        {"C:\\photos\\cup.jpg", "cup.jpg"},
        {"a/b\\c/cup 2.jpg", "cup 2.jpg"},
        {"..", "file"},
        {"...", "file"},
        {"", "file"},
        {"photos/", "file"},
        {".htaccess", "htaccess"},
        {". ..cup", "cup"},
        {"a\nb\tc\x7f;\"'$`|<>*?", "a_b_c___________"},
        {"\xc3\xbc.png", "\xc3\xbc.png"},
    };
    char name[SAFE_NAME];
    (void)state;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        safe_name(names[i][0], name);
        assert_string_equal(name, names[i][1]);
    }
}

static void long_names_keep_their_ending(void **state)
{
    char given[4096], name[SAFE_NAME];
    (void)state;
    memset(given, 'a', sizeof given);
    memcpy(given + sizeof given - 5, ".png", 5);
    safe_name(given, name);
    assert_true(strlen(name) < SAFE_NAME);
    assert_string_equal(name + strlen(name) - 4, ".png");
    safe_name_number(name, 1024);
    assert_true(strlen(name) < SAFE_NAME);
    assert_string_equal(name + strlen(name) - 9, "_1024.png");
    safe_name("file", name);
    safe_name_number(name, 7);
    assert_string_equal(name, "file_7");
}

static void files_of_one_name_get_names_of_their_own(void **state)
{
    form f = {.bytes = 0};
    (void)state;
    for (int i = 0; i < 40; i++)
        assert_non_null(form_add_file(&f, "pictures", "../a.png"));
    for (size_t i = 1; i < f.file_count; i++) /* in their order, by which lights are theirs */
        assert_true(file_compare_names(f.files[i - 1].name, f.files[i].name) < 0);
    form_free(&f);
}

static void put(form *f, const char *key, const char *value)
{
    form_field *field = form_add_field(f, key);
    assert_non_null(field);
    snprintf(field->value, sizeof field->value, "%s", value);
}

static void values_are_read_whole_or_refused(void **state)
{
    static const char *const no_numbers[] = {"", " ", "nan", "inf", "1e99", "12x", "0x10", "1,5", "-1", "101"};
    (void)state;
    for (size_t i = 0; i < sizeof no_numbers / sizeof *no_numbers; i++) {
        form f = {.bytes = 0};
        float real = 7;
        int whole = 7;
        put(&f, "n", no_numbers[i]);
        assert_int_equal(form_real(&f, "n", 0, 100, &real), MERLIN_WRONG_USE);
        assert_int_equal(form_integer(&f, "n", 0, 100, &whole), MERLIN_WRONG_USE);
        assert_true(real == 7 && whole == 7);
        form_free(&f);
    }
}

static void values_that_are_not_sent_stay_as_they_are(void **state)
{
    form f = {.bytes = 0};
    float real = 7, three[3];
    int whole = 7, flag = 1;
    (void)state;
    put(&f, "light", "0.5,-1,2e-1");
    put(&f, "light", "1,2,3,4");
    put(&f, "view", "off");
    assert_int_equal(form_real(&f, "n", 0, 1, &real), OK);
    assert_int_equal(form_integer(&f, "n", 0, 1, &whole), OK);
    assert_int_equal(form_flag(&f, "n", &flag), OK);
    assert_true(real == 7 && whole == 7 && flag == 1);
    assert_int_equal(form_flag(&f, "view", &flag), OK);
    assert_int_equal(flag, 0);
    assert_int_equal(form_numbers(&f, "light", 0, -10, 10, 3, three), OK);
    assert_true(three[0] == 0.5f && three[1] == -1 && three[2] == 0.2f);
    assert_int_equal(form_numbers(&f, "light", 1, -10, 10, 3, three), MERLIN_WRONG_USE);
    assert_int_equal(form_numbers(&f, "light", 2, -10, 10, 3, three), MERLIN_WRONG_USE);
    form_free(&f);
}

static void what_is_not_known_is_refused(void **state)
{
    static const form_key known[] = {{"photo", FORM_FILE, 1}, {"size", FORM_VALUE, 2}, {0}};
    form f = {.bytes = 0};
    (void)state;
    put(&f, "size", "1");
    put(&f, "size", "2");
    assert_non_null(form_add_file(&f, "photo", "a.png"));
    assert_int_equal(form_check(&f, "estimate", known), OK);
    put(&f, "size", "3");
    assert_int_equal(form_check(&f, "estimate", known), MERLIN_WRONG_USE);
    assert_string_equal(status_message(), "size is given 3 times, and estimate takes 2 at most");
    form_free(&f);
    put(&f, "colour", "3");
    assert_int_equal(form_check(&f, "estimate", known), MERLIN_WRONG_USE);
    assert_string_equal(status_message(), "estimate knows no field \"colour\": it has photo, size");
    form_free(&f);
    put(&f, "photo", "3");
    assert_int_equal(form_check(&f, "estimate", known), MERLIN_WRONG_USE);
    assert_string_equal(status_message(), "photo of estimate is a file: its part needs a filename");
    form_free(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_become_plain_ones),
        cmocka_unit_test(long_names_keep_their_ending),
        cmocka_unit_test(files_of_one_name_get_names_of_their_own),
        cmocka_unit_test(values_are_read_whole_or_refused),
        cmocka_unit_test(values_that_are_not_sent_stay_as_they_are),
        cmocka_unit_test(what_is_not_known_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
