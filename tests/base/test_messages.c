/* SPDX-License-Identifier: MIT */
/* The program's own messages are shown, those of libraries inside a decoder are not. */
#include "base/messages.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

static void speak(void)
{
    messages_mute();
    messages_mute();
    (void)!write(STDERR_FILENO, "library\n", 8);
    fprintf(messages(), "one\n");
    messages_unmute();
    (void)!write(STDERR_FILENO, "library\n", 8);
    messages_unmute();
    (void)!write(STDERR_FILENO, "abort\n", 6);
    fprintf(messages(), "two\n");
}

/* Captures what a process prints that keeps its messages, or does not. */
static void hear(int keep, char *heard, size_t room)
{
    int ends[2];
    assert_int_equal(pipe(ends), 0);
    pid_t child = fork();
    if (child == 0) {
        dup2(ends[1], STDERR_FILENO);
        if (keep) messages_keep();
        speak();
        _exit(0);
    }
    close(ends[1]);
    size_t size = 0;
    for (ssize_t got; size + 1 < room && (got = read(ends[0], heard + size, room - 1 - size)) > 0;)
        size += (size_t)got;
    heard[size] = 0;
    close(ends[0]);
    assert_true(child > 0 && waitpid(child, NULL, 0) == child);
}

static void what_libraries_print_in_a_decoder_is_lost(void **state)
{
    (void)state;
    char heard[256];
    unsetenv("MERLIN_LIBRARY_MESSAGES");
    hear(1, heard, sizeof heard);
#ifdef __SANITIZE_ADDRESS__
    assert_string_equal(heard, "library\none\nlibrary\nabort\ntwo\n");
#else
    assert_string_equal(heard, "one\nabort\ntwo\n");
#endif
}

static void who_asks_for_it_hears_all(void **state)
{
    (void)state;
    char heard[256];
    hear(0, heard, sizeof heard);
    assert_string_equal(heard, "library\none\nlibrary\nabort\ntwo\n");
    setenv("MERLIN_LIBRARY_MESSAGES", "1", 1);
    hear(1, heard, sizeof heard);
    assert_string_equal(heard, "library\none\nlibrary\nabort\ntwo\n");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_libraries_print_in_a_decoder_is_lost),
        cmocka_unit_test(who_asks_for_it_hears_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
