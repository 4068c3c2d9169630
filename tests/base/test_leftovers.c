/* SPDX-License-Identifier: MIT */
#include <fcntl.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/file.h"
#include "base/leftovers.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

static char *folder;

static char *path_of(const char *name)
{
    char *path = file_join(folder, name);
    assert_non_null(path);
    return path;
}

static void make_file(const char *name)
{
    char *path = path_of(name);
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fclose(f);
    free(path);
}

static bool is_there(const char *name)
{
    return file_is_in(folder, name);
}

/* Starts a process that writes a file and a folder with a file, and is killed; its names are left in the folder. */
static void let_one_die(void)
{
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        char front[LEFTOVERS_FRONT], name[LEFTOVERS_NAME];
        leftovers_file_front(front);
        leftovers_folder_name(name);
        strcat(front, "a");
        make_file(front);
        char *hidden = mkdtemp(path_of(name)), *inside = file_join(hidden, "b.png");
        fclose(fopen(inside, "w"));
        kill(getpid(), SIGKILL);
    }
    int how;
    assert_int_equal(waitpid(child, &how, 0), child);
    assert_true(WIFSIGNALED(how));
}

static int count_of_names(void)
{
    char command[4200];
    snprintf(command, sizeof command, "ls -A '%s' | wc -l", folder);
    FILE *f = popen(command, "r");
    int count = -1;
    assert_non_null(f);
    assert_int_equal(fscanf(f, "%d", &count), 1);
    pclose(f);
    return count;
}

static void what_the_dead_left_is_removed(void **state)
{
    (void)state;
    let_one_die();
    assert_int_equal(count_of_names(), 2);
    leftovers_clear(folder);
    assert_int_equal(count_of_names(), 0);
}

static void what_the_living_write_and_others_have_stays(void **state)
{
    (void)state;
    char front[LEFTOVERS_FRONT], name[LEFTOVERS_NAME];
    leftovers_file_front(front);
    strcat(front, "a");
    make_file(front);
    leftovers_folder_name(name);
    char *hidden = mkdtemp(path_of(name));
    static const char *const others[] = {".merlin-notes", ".12~a", ".00000000-1~", ".bashrc", "a.png"};
    for (int i = 0; i < 5; i++)
        make_file(others[i]);
    leftovers_clear(folder);
    assert_int_equal(count_of_names(), 7);
    assert_int_equal(rmdir(hidden), 0);
    free(hidden);
}

/* Another machine's process may still be running. */
static void those_of_another_machine_go_after_a_day(void **state)
{
    (void)state;
    make_file(".00000001-1~new");
    make_file(".00000001-1~old");
    char *old = path_of(".00000001-1~old");
    const struct timespec times[2] = {{.tv_sec = 1000000000}, {.tv_sec = 1000000000}};
    assert_int_equal(utimensat(AT_FDCWD, old, times, 0), 0);
    leftovers_clear(folder);
    assert_true(is_there(".00000001-1~new"));
    assert_false(is_there(".00000001-1~old"));
    free(old);
}

static void a_file_is_written_where_one_died(void **state)
{
    (void)state;
    let_one_die();
    char *path = path_of("a");
    assert_int_equal(file_write(path, "a", 1), OK);
    assert_true(is_there("a"));
    assert_int_equal(count_of_names(), 1);
    free(path);
}

static void ones_own_can_be_removed(void **state)
{
    (void)state;
    char *file = path_of("file"), *made = path_of("made"), *hidden = path_of("made/hidden"),
         *inside = path_of("made/hidden/x");
    make_file("file");
    assert_int_equal(file_make_folder(hidden), OK);
    assert_int_equal(file_write(inside, "x", 1), OK);
    make_file("other");
    leftovers_note(file, 0);
    leftovers_note(hidden, strlen(folder));
    leftovers_remove_own();
    assert_int_equal(count_of_names(), 1);
    leftovers_forget(file);
    leftovers_forget(hidden);
    make_file("file");
    leftovers_remove_own();
    assert_true(is_there("file"));
    free(file);
    free(made);
    free(hidden);
    free(inside);
}

static int make_folder(void **state)
{
    (void)state;
    char name[] = "/tmp/merlin-leftovers-XXXXXX";
    folder = mkdtemp(name) ? strdup(name) : NULL;
    return folder ? 0 : -1;
}

static int remove_made_folder(void **state)
{
    (void)state;
    char command[4200];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    int failed = system(command);
    free(folder);
    return failed;
}

#define IN_A_FOLDER(test) cmocka_unit_test_setup_teardown(test, make_folder, remove_made_folder)

int main(void)
{
    const struct CMUnitTest tests[] = {
        IN_A_FOLDER(what_the_dead_left_is_removed),
        IN_A_FOLDER(what_the_living_write_and_others_have_stays),
        IN_A_FOLDER(those_of_another_machine_go_after_a_day),
        IN_A_FOLDER(a_file_is_written_where_one_died),
        IN_A_FOLDER(ones_own_can_be_removed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
