/* SPDX-License-Identifier: MIT */
#include "base/lights/light_list.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "comma.h"
#include "scratch.h"

static status parse(const char *text, light_list *out)
{
    return light_list_parse(text, strlen(text), "lights.txt", out);
}

static void assert_refused(const char *text, const char *words)
{
    light_list lights;
    assert_int_equal(parse(text, &lights), MERLIN_BAD_INPUT);
    assert_null(lights.at);
    if (!strstr(status_message(), words)) fail_msg("\"%s\" does not say \"%s\"", status_message(), words);
    assert_null(strchr(status_message(), '\n'));
}

static void plain_lists_are_positions(void **state)
{
    (void)state;
    light_list lights;
    assert_int_equal(parse("# from the left\n-0.5 0.25 -0.5\n\n 1,2, 3 # the far one\r\n0\t0\t0", &lights), OK);
    assert_int_equal(lights.count, 3);
    assert_null(lights.name);
    assert_float_equal(lights.at[0].x, -0.5, 0);
    assert_float_equal(lights.at[1].z, 3, 0);
    assert_float_equal(lights.at[2].y, 0, 0);
    light_list_free(&lights);
}

static void lists_that_begin_with_a_count_are_about_the_object(void **state)
{
    (void)state;
    light_list lights;
    assert_int_equal(parse("2\na.jpg 0 0 2\nb.jpg 3 0 4\n", &lights), OK);
    assert_int_equal(lights.count, 2);
    assert_true(lights.about_object);
    assert_float_equal(lights.at[1].x, 3, 0);
    assert_float_equal(light_list_direction(&lights, 1).x, 0.6, 1e-6);
    assert_float_equal(light_list_direction(&lights, 1).z, 0.8, 1e-6);
    assert_string_equal(lights.name[0], "a.jpg");
    assert_string_equal(lights.name[1], "b.jpg");
    light_list_free(&lights);
    assert_int_equal(parse("1\n0 0 2\n", &lights), OK);
    assert_true(lights.about_object);
    assert_null(lights.name);
    light_list_free(&lights);
    static const char lp[] = "a.jpg 0 0 2\n";
    assert_int_equal(light_list_parse(lp, sizeof lp - 1, "dome.LP", &lights), OK);
    assert_true(lights.about_object);
    light_list_free(&lights);
    assert_int_equal(parse(lp, &lights), OK);
    assert_false(lights.about_object);
    light_list_free(&lights);
}

static void names_may_have_blanks_and_signs_and_numbers(void **state)
{
    (void)state;
    light_list lights;
    assert_int_equal(
        parse("3\n C:\\my set\\a#1.jpg 0 0 1\nb 2 .jpg,\t0, 3,4 # a comment\n#c.jpg 0 0 1\n0 0 0 1\n", &lights), OK);
    assert_int_equal(lights.count, 3);
    assert_string_equal(lights.name[0], "C:\\my set\\a#1.jpg");
    assert_string_equal(lights.name[1], "b 2 .jpg");
    assert_float_equal(light_list_direction(&lights, 1).y, 0.6, 1e-6);
    assert_string_equal(lights.name[2], "0");
    light_list_free(&lights);
}

static void numbers_may_have_decimal_commas(void **state)
{
    (void)state;
    light_list lights;
    assert_int_equal(parse("3\na,b 1.jpg 0,6 0 0,8\r\nb.jpg\t-0,8\t+6e-1\t0\nc.jpg 1,0, 0\n", &lights), OK);
    assert_int_equal(lights.count, 3);
    assert_string_equal(lights.name[0], "a,b 1.jpg");
    assert_float_equal(light_list_direction(&lights, 0).x, 0.6, 1e-6);
    assert_float_equal(light_list_direction(&lights, 1).x, -0.8, 1e-6);
    assert_float_equal(light_list_direction(&lights, 2).x, 1, 1e-6);
    light_list_free(&lights);
    assert_int_equal(parse("-0,5 0,25 1\n1,0, 3\n", &lights), OK);
    assert_int_equal(lights.count, 2);
    assert_float_equal(lights.at[0].x, -0.5, 0);
    assert_float_equal(lights.at[1].z, 3, 0);
    light_list_free(&lights);
    assert_refused("0,5 ,25 1\n", "write decimal points");
    assert_refused("0,5,5 0 1\n", "found 5 words");
}

static void programs_with_decimal_commas_read_the_same(void **state)
{
    (void)state;
    light_list lights;
    if (!comma_begin(scratch)) return;
    status s = parse("1\na.jpg 0.6 0 8e-1\n", &lights);
    comma_end();
    if (s != OK) fail_msg("%s", status_message());
    assert_float_equal(light_list_direction(&lights, 0).x, 0.6, 1e-6);
    assert_float_equal(light_list_direction(&lights, 0).z, 0.8, 1e-6);
    light_list_free(&lights);
}

static void a_mark_of_windows_before_the_text_is_skipped(void **state)
{
    (void)state;
    light_list lights;
    assert_int_equal(parse("\xef\xbb\xbf"
                           "0.5 0 0\r\n",
                           &lights),
                     OK);
    assert_true(lights.at[0].x == (real)0.5);
    light_list_free(&lights);
    assert_refused("\xef\xbb\xbf", "no lights");
}

static void a_list_may_have_one_light(void **state)
{
    (void)state;
    light_list lights;
    assert_int_equal(parse("1\nonly.png 0 1 0", &lights), OK);
    assert_int_equal(lights.count, 1);
    light_list_free(&lights);
}

static void values_that_are_no_finite_numbers_are_refused(void **state)
{
    (void)state;
    assert_refused("0 0 0\n0 nan 0\n", "lights.txt:2");
    assert_refused("0 0 inf\n", "lights.txt:1");
    assert_refused("0 0 1e99\n", "finite");
    assert_refused("0 0 left\n", "left");
    assert_refused("0 0 1x\n", "1x");
    assert_refused("0 0 5e6\n", "range");
}

static void positions_may_be_in_millimetres(void **state)
{
    (void)state;
    light_list lights;
    assert_int_equal(parse("0 0 0\n-1262.5 850 -1400\n", &lights), OK);
    assert_float_equal(lights.at[1].x, -1262.5, 0);
    assert_float_equal(lights.at[1].z, -1400, 0);
    light_list_free(&lights);
}

static void lines_of_another_shape_are_refused(void **state)
{
    (void)state;
    assert_refused("0 0\n", "lights.txt:1");
    assert_refused("0 0 0\n1 2 3 4\n", "lights.txt:2");
    assert_refused("1\na 0 0 0\n", "no length");
    assert_refused("lights\n", "lights");
}

static void counts_that_do_not_fit_are_refused(void **state)
{
    (void)state;
    assert_refused("3\na 0 0 1\n", "3 lights");
    assert_refused("1\na 0 0 1\nb 0 0 1\n", "1 light, but there are 2");
    assert_refused("0\n", "lights.txt:1");
    assert_refused("-2\n", "lights.txt:1");
    assert_refused("1000000\n", "more than 4096");
}

static void empty_lists_are_refused(void **state)
{
    (void)state;
    assert_refused("", "no lights");
    assert_refused("\n  \n# nothing\n", "no lights");
}

static void binary_files_are_refused(void **state)
{
    (void)state;
    light_list lights;
    static const char bytes[] = "0 0\0 0\n";
    assert_int_equal(light_list_parse(bytes, sizeof bytes - 1, "lights.txt", &lights), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "not a text file"));
}

static void overlong_lines_and_lists_are_refused(void **state)
{
    (void)state;
    size_t size = 6 * (LIGHT_LIST_MAX + 1);
    char *text = malloc(size + 1);
    for (size_t i = 0; i <= LIGHT_LIST_MAX; i++)
        strcpy(text + 6 * i, "0 0 1\n");
    assert_refused(text, "more than 4096");
    memset(text, '1', size);
    assert_refused(text, "too long");
    free(text);
}

static void missing_files_are_named(void **state)
{
    (void)state;
    light_list lights;
    assert_int_equal(light_list_read("no-such-list.lp", &lights), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "no-such-list.lp"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plain_lists_are_positions),
        cmocka_unit_test(lists_that_begin_with_a_count_are_about_the_object),
        cmocka_unit_test(names_may_have_blanks_and_signs_and_numbers),
        cmocka_unit_test(numbers_may_have_decimal_commas),
        in_scratch(programs_with_decimal_commas_read_the_same),
        cmocka_unit_test(a_mark_of_windows_before_the_text_is_skipped),
        cmocka_unit_test(a_list_may_have_one_light),
        cmocka_unit_test(values_that_are_no_finite_numbers_are_refused),
        cmocka_unit_test(positions_may_be_in_millimetres),
        cmocka_unit_test(lines_of_another_shape_are_refused),
        cmocka_unit_test(counts_that_do_not_fit_are_refused),
        cmocka_unit_test(empty_lists_are_refused),
        cmocka_unit_test(binary_files_are_refused),
        cmocka_unit_test(overlong_lines_and_lists_are_refused),
        cmocka_unit_test(missing_files_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
