/* SPDX-License-Identifier: MIT */
/* Bodies that fail in parallel loops. */
#include "base/parallel.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

enum { COUNT = 400 };

typedef struct work {
    atomic_int done[COUNT];
    size_t failing[2];
} work;

static status body(void *context, size_t i)
{
    work *w = context;
    w->done[i]++;
    for (int k = 0; k < 2; k++)
        if (i == w->failing[k]) return (fail)(MERLIN_BAD_INPUT, "number %zu", i);
    return OK;
}

static void all_is_done_where_nothing_fails(void **state)
{
    (void)state;
    work w = {.failing = {COUNT, COUNT}};
    assert_int_equal(parallel_try(COUNT, body, &w), OK);
    for (int i = 0; i < COUNT; i++)
        assert_int_equal(w.done[i], 1);
    assert_int_equal(parallel_try(0, body, &w), OK);
}

/* The first by index is meant, whichever fails first in time and in whichever thread. */
static void the_first_failure_is_heard(void **state)
{
    (void)state;
    for (int round = 0; round < 50; round++) {
        work w = {.failing = {8, 7}};
        assert_int_equal(parallel_try(COUNT, body, &w), MERLIN_BAD_INPUT);
        assert_string_equal(status_message(), "number 7");
        for (int i = 0; i < 8; i++)
            assert_int_equal(w.done[i], 1);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_is_done_where_nothing_fails),
        cmocka_unit_test(the_first_failure_is_heard),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
