/* SPDX-License-Identifier: MIT */
#include "base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <pthread.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "comma.h"
#include "scratch.h"

static char folder[] = "/tmp/merlin-file-XXXXXX";

static int make_folder(void **state)
{
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

/* Removes the test's folder; rmdir fails if a test left anything in it. */
static int remove_folder(void **state)
{
    (void)state;
    return rmdir(folder);
}

static char *in_folder(const char *name)
{
    char *path = file_join(folder, name);
    assert_non_null(path);
    return path;
}

static size_t entries(void)
{
    char **names;
    size_t count;
    assert_int_equal(file_list(folder, NULL, &names, &count), OK);
    file_list_free(names, count);
    return count;
}

static void what_was_written_is_read(void **state)
{
    (void)state;
    char *path = in_folder("a"), *data = NULL;
    size_t size = 0;
    assert_int_equal(file_write(path, "one\0two", 7), OK);
    assert_int_equal(file_read(path, 100, &data, &size), OK);
    assert_int_equal(size, 7);
    assert_memory_equal(data, "one\0two", 8); /* with a zero after it */
    free(data);
    assert_int_equal(file_write(path, "", 0), OK);
    assert_int_equal(file_read(path, 100, &data, &size), OK);
    assert_int_equal(size, 0);
    free(data);
    file_view view;
    assert_int_equal(file_map(path, 100, &view), OK);
    assert_int_equal(view.size, 0);
    assert_int_equal(file_write(path, "one\0two", 7), OK);
    assert_int_equal(file_map(path, 6, &view), MERLIN_BAD_INPUT);
    assert_null(view.data);
    assert_int_equal(file_map(path, 7, &view), OK);
    assert_int_equal(view.size, 7);
    assert_memory_equal(view.data, "one\0two", 7);
    file_unmap(&view);
    assert_null(view.data);
    unlink(path);
    free(path);
}

static void larger_files_than_wanted_are_refused(void **state)
{
    (void)state;
    char *path = in_folder("a"), *data = NULL;
    size_t size = 0;
    assert_int_equal(file_write(path, "12345", 5), OK);
    assert_int_equal(file_read(path, 4, &data, &size), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), path));
    assert_int_equal(file_read(folder, 100, &data, &size), MERLIN_BAD_INPUT);
    assert_int_equal(file_read("/nowhere/a", 100, &data, &size), MERLIN_BAD_INPUT);
    unlink(path);
    free(path);
}

/* The disk is filled by a limit on the size of files. */
static void a_write_that_fails_leaves_the_old_file_and_no_other(void **state)
{
    (void)state;
    char *path = in_folder("a"), *data = NULL;
    size_t size = 0;
    char *large = calloc(1, 1 << 20);
    assert_non_null(large);
    assert_int_equal(file_write(path, "old", 3), OK);
    struct rlimit before, tight;
    getrlimit(RLIMIT_FSIZE, &before);
    tight = before;
    tight.rlim_cur = 4096;
    signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &tight);
    status s = file_write(path, large, 1 << 20);
    setrlimit(RLIMIT_FSIZE, &before);
    signal(SIGXFSZ, SIG_DFL);
    assert_int_equal(s, MERLIN_CANNOT_WRITE);
    assert_non_null(strstr(status_message(), path));
    assert_int_equal(file_read(path, 100, &data, &size), OK);
    assert_string_equal(data, "old");
    assert_int_equal(entries(), 1);
    unlink(path);
    free(large), free(data), free(path);
}

static void *write_often(void *path)
{
    uintptr_t failures = 0;
    for (int i = 0; i < 1000; i++)
        failures += file_write(path, "whole", 5) != OK;
    return (void *)failures;
}

static void threads_may_write_one_file(void **state)
{
    (void)state;
    char *path = in_folder("shared"), *data;
    pthread_t other;
    void *failures;
    size_t size;
    assert_int_equal(pthread_create(&other, NULL, write_often, path), 0);
    assert_null(write_often(path));
    assert_int_equal(pthread_join(other, &failures), 0);
    assert_null(failures);
    assert_int_equal(file_read(path, 100, &data, &size), OK);
    assert_string_equal(data, "whole");
    assert_int_equal(unlink(path), 0);
    free(data);
    free(path);
}

static void an_interrupted_write_leaves_the_old_file(void **state)
{
    (void)state;
    char *path = in_folder("a.png"), *temporary = NULL, *data = NULL;
    size_t size = 0;
    assert_int_equal(file_write(path, "old", 3), OK);
    assert_int_equal(file_temporary(path, &temporary), OK);
    assert_string_equal(strrchr(temporary, '.'), ".png");
    FILE *f = fopen(temporary, "wb");
    assert_non_null(f);
    fputs("ne", f);
    fclose(f);
    assert_int_equal(file_read(path, 100, &data, &size), OK);
    assert_string_equal(data, "old");
    free(data);
    assert_int_equal(entries(), 1); /* half-written files are not listed */
    file_discard(temporary);
    file_discard(NULL);
    unlink(path);
    free(path);
}

static void print_a_number(FILE *f, const void *context)
{
    const double *number = context;
    fprintf(f, "%g", *number);
}

static void printed_numbers_have_points_in_every_locale(void **state)
{
    (void)state;
    char *path = in_folder("number"), *data, *made = scratch_new(), outside[8] = "";
    size_t size;
    const double half = 0.5;
    bool comma = comma_begin(made);
    status s = file_print(path, print_a_number, &half);
    snprintf(outside, sizeof outside, "%g", half);
    comma_end();
    scratch_remove(made);
    assert_int_equal(s, OK);
    assert_int_equal(file_read(path, 10, &data, &size), OK);
    assert_string_equal(data, "0.5");
    assert_string_equal(outside, comma ? "0,5" : "0.5"); /* the program's own locale stays */
    unlink(path);
    free(data);
    free(path);
}

static void a_print_that_fails_says_why(void **state)
{
    (void)state;
    char *nowhere = in_folder("no/such");
    const double half = 0.5;
    assert_int_equal(file_print(nowhere, print_a_number, &half), MERLIN_CANNOT_WRITE);
    assert_non_null(strstr(status_message(), nowhere));
    assert_non_null(strstr(status_message(), "No such file"));
    free(nowhere);
}

static void what_is_no_plain_file_is_not_replaced(void **state)
{
    (void)state;
    char *pipe = in_folder("pipe");
    struct stat about;
    assert_int_equal(mkfifo(pipe, 0600), 0);
    assert_int_equal(file_write(pipe, "new", 3), MERLIN_CANNOT_WRITE);
    assert_non_null(strstr(status_message(), pipe));
    assert_int_equal(file_check_writable(pipe), MERLIN_CANNOT_WRITE);
    assert_int_equal(stat(pipe, &about), 0);
    assert_true(S_ISFIFO(about.st_mode));
    unlink(pipe);
    assert_int_equal(entries(), 0);
    free(pipe);
}

/* A pipe with a reader can be opened for writing; one without would block. */
static void what_is_no_plain_file_is_not_opened(void **state)
{
    (void)state;
    char *pipe = in_folder("pipe"), *data;
    size_t size;
    file_view view;
    assert_int_equal(mkfifo(pipe, 0600), 0);
    FILE *f = file_open(pipe);
    assert_non_null(f);
    assert_int_equal(open(pipe, O_WRONLY | O_NONBLOCK), -1);
    assert_int_equal(errno, ENXIO);
    assert_int_equal(fgetc(f), EOF);
    fclose(f);
    const char *const paths[] = {pipe, "/dev/zero", folder};
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
        assert_int_equal(file_read(paths[i], 100, &data, &size), MERLIN_BAD_INPUT);
        assert_int_equal(file_map(paths[i], 100, &view), MERLIN_BAD_INPUT);
        assert_int_equal(file_check_plain(paths[i]), MERLIN_BAD_INPUT);
        assert_non_null(strstr(status_message(), "is not a plain file"));
        assert_non_null(strstr(status_message(), paths[i]));
    }
    assert_int_equal(file_check_plain("/nowhere/a"), MERLIN_BAD_INPUT);
    unlink(pipe);
    free(pipe);
}

/* Names have as many bytes as are allowed, in characters of three bytes. */
static void the_longest_names_can_be_written(void **state)
{
    (void)state;
    char name[NAME_MAX + 1] = "", *temporary, *data;
    size_t size;
    while (strlen(name) < NAME_MAX - 6)
        strcat(name, "\u6587");
    strcat(name, ".png");
    char *path = in_folder(name);
    assert_int_equal(file_write(path, "new", 3), OK);
    assert_int_equal(file_read(path, 10, &data, &size), OK);
    assert_int_equal(file_temporary(path, &temporary), OK);
    assert_string_equal(strrchr(temporary, '.'), ".png");
    assert_int_equal(strncmp(strchr(temporary, '~') + 1, "\u6587", 3), 0);
    file_discard(temporary);
    unlink(path);
    free(data);
    free(path);
}

static void whether_a_file_can_be_written_is_known_before_it_is(void **state)
{
    (void)state;
    char *path = in_folder("later"), *nowhere = in_folder("no/such"), *data;
    size_t size;
    assert_int_equal(file_check_writable(path), OK);
    assert_int_equal(entries(), 0);
    assert_int_equal(file_check_writable(nowhere), MERLIN_CANNOT_WRITE);
    assert_non_null(strstr(status_message(), nowhere));
    assert_int_equal(file_check_writable(folder), MERLIN_CANNOT_WRITE);
    assert_int_equal(file_write(path, "old", 3), OK);
    assert_int_equal(file_check_writable(path), OK);
    assert_int_equal(file_read(path, 10, &data, &size), OK);
    assert_string_equal(data, "old");
    unlink(path);
    free(data);
    free(path);
    free(nowhere);
}

static void committing_replaces_the_file(void **state)
{
    (void)state;
    char *path = in_folder("a.png"), *temporary = NULL, *data = NULL;
    size_t size = 0;
    assert_int_equal(file_write(path, "old", 3), OK);
    assert_int_equal(file_temporary(path, &temporary), OK);
    FILE *f = fopen(temporary, "wb");
    assert_non_null(f);
    fputs("new", f);
    fclose(f);
    assert_int_equal(file_commit(temporary, path), OK);
    assert_int_equal(file_read(path, 100, &data, &size), OK);
    assert_string_equal(data, "new");
    free(data);
    assert_int_equal(file_temporary(path, &temporary), OK);
    assert_int_equal(file_commit(temporary, path), MERLIN_CANNOT_WRITE); /* the temporary file was not written */
    unlink(path);
    free(path);
}

static void a_folder_without_a_name_is_refused(void **state)
{
    (void)state;
    assert_int_equal(file_make_folder(""), MERLIN_CANNOT_WRITE);
    assert_non_null(strstr(status_message(), "no name"));
}

static void folders_are_made_with_those_above(void **state)
{
    (void)state;
    char *deep = in_folder("x/y/z"), *file = in_folder("f"), *below = in_folder("f/z");
    assert_int_equal(file_make_folder(deep), OK);
    assert_int_equal(file_make_folder(deep), OK);
    assert_true(file_is_folder(deep) && file_exists(deep));
    assert_int_equal(file_write(file, "", 0), OK);
    assert_true(file_exists(file) && !file_is_folder(file));
    assert_int_equal(file_make_folder(below), MERLIN_CANNOT_WRITE);
    assert_non_null(strstr(status_message(), "a file of that name is in the way"));
    assert_int_equal(file_make_folder("/proc/self/x/y"), MERLIN_CANNOT_WRITE);
    assert_non_null(strstr(status_message(), "No such file or directory")); /* mkdir's message */
    unlink(file);
    for (int i = 0; i < 3; i++, *strrchr(deep, '/') = 0)
        rmdir(deep);
    free(deep), free(file), free(below);
}

static void numbers_in_names_count_whatever_their_zeros(void **state)
{
    (void)state;
    static const char *const sorted[] = {"1.png", "02.png", "3.png", "04.png", "9.png", "10.png", "a",
                                         "a0",    "a00",    "a1b2",  "a01b3",  "a1b10", "b"};
    for (int i = 0; i < 13; i++)
        for (int k = 0; k < 13; k++) {
            int order = file_compare_names(sorted[i], sorted[k]);
            assert_int_equal((order > 0) - (order < 0), (i > k) - (i < k));
        }
}

static void lists_are_sorted_as_people_count_and_of_the_wanted_endings(void **state)
{
    (void)state;
    static const char *const made[] = {"b10.png",  "b9~2.png", "a.PNG",  "c.jpg",   ".hidden.png", "png",
                                       "0009.png", "0010.png", "b9.png", "b9.png~", ".7~a.png"};
    static const char *const endings[] = {".png", NULL};
    static const char *const listed[] = {"/0009.png", "/0010.png", "/a.PNG", "/b9.png", "/b9~2.png", "/b10.png"};
    for (int i = 0; i < 11; i++) {
        char *path = in_folder(made[i]);
        assert_int_equal(file_write(path, "", 0), OK);
        free(path);
    }
    char **names;
    size_t count;
    assert_int_equal(file_list(folder, endings, &names, &count), OK);
    assert_int_equal(count, 6);
    for (int i = 0; i < 6; i++)
        assert_string_equal(strrchr(names[i], '/'), listed[i]);
    file_list_free(names, count);
    assert_int_equal(file_list("/nowhere", endings, &names, &count), MERLIN_BAD_INPUT);
    for (int i = 0; i < 11; i++) {
        char *path = in_folder(made[i]);
        unlink(path);
        free(path);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_was_written_is_read),
        cmocka_unit_test(larger_files_than_wanted_are_refused),
        cmocka_unit_test(a_write_that_fails_leaves_the_old_file_and_no_other),
        cmocka_unit_test(threads_may_write_one_file),
        cmocka_unit_test(an_interrupted_write_leaves_the_old_file),
        cmocka_unit_test(printed_numbers_have_points_in_every_locale),
        cmocka_unit_test(a_print_that_fails_says_why),
        cmocka_unit_test(what_is_no_plain_file_is_not_replaced),
        cmocka_unit_test(what_is_no_plain_file_is_not_opened),
        cmocka_unit_test(the_longest_names_can_be_written),
        cmocka_unit_test(whether_a_file_can_be_written_is_known_before_it_is),
        cmocka_unit_test(committing_replaces_the_file),
        cmocka_unit_test(a_folder_without_a_name_is_refused),
        cmocka_unit_test(folders_are_made_with_those_above),
        cmocka_unit_test(numbers_in_names_count_whatever_their_zeros),
        cmocka_unit_test(lists_are_sorted_as_people_count_and_of_the_wanted_endings),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
