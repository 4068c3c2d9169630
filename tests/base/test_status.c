/* SPDX-License-Identifier: MIT */
#include "base/status.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static void a_context_stands_before_the_message(void **state)
{
    (void)state;
    assert_int_equal((fail)(MERLIN_BAD_INPUT, "it is %d bytes", 3), MERLIN_BAD_INPUT);
    assert_int_equal(fail_in(MERLIN_BAD_INPUT, "cannot read %s", "a.exr"), MERLIN_BAD_INPUT);
    assert_string_equal(status_message(), "cannot read a.exr: it is 3 bytes");
}

/* The context may be a file's name, which may contain anything and be longer than a message. */
static void messages_are_one_line_however_long_their_context(void **state)
{
    (void)state;
    char name[3000] = "two\nlines";
    for (size_t length = strlen(name); length < sizeof name - 1; length++) {
        (fail)(MERLIN_BAD_INPUT, "no\tsuch file");
        fail_in(MERLIN_BAD_INPUT, "%s", name);
        assert_null(strpbrk(status_message(), "\n\t"));
        assert_ptr_equal(strstr(status_message(), "two?lines"), status_message());
        name[length] = 'a';
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_context_stands_before_the_message),
        cmocka_unit_test(messages_are_one_line_however_long_their_context),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
