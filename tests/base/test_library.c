/* SPDX-License-Identifier: MIT */
#include "base/library.h"

#include <math.h>
#include <pthread.h>
#include <stdbool.h>
#include <string.h>

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static struct {
    __typeof__(cbrt) *cbrt;
    __typeof__(hypot) *hypot;
} maths;

static const library_function wanted[] = {{"cbrt", &maths.cbrt}, {"hypot", &maths.hypot}};

static void *load_and_compute(void *context)
{
    bool *right = context;
    static library shared = {.file = "libm.so.6", .functions = wanted, .count = 2};
    *right = library_need(&shared) == OK && maths.cbrt(8) == 2 && maths.hypot(3, 4) == 5;
    return NULL;
}

static void functions_can_be_called_by_every_thread_that_needs_them(void **state)
{
    (void)state;
    enum { THREADS = 8 };
    pthread_t threads[THREADS];
    bool right[THREADS] = {false};
    for (int i = 0; i < THREADS; i++)
        assert_int_equal(pthread_create(&threads[i], NULL, load_and_compute, &right[i]), 0);
    for (int i = 0; i < THREADS; i++) {
        assert_int_equal(pthread_join(threads[i], NULL), 0);
        assert_true(right[i]);
    }
}

static void a_missing_library_is_named_each_time(void **state)
{
    (void)state;
    library missing = {.file = "libnone-of-this-name.so.6", .functions = wanted, .count = 2};
    for (int i = 0; i < 2; i++) {
        assert_int_equal(library_need(&missing), MERLIN_DEVICE_FAILED);
        assert_non_null(strstr(status_message(), "libnone-of-this-name.so.6"));
    }
}

static void a_library_without_a_function_is_refused(void **state)
{
    (void)state;
    void *none;
    const library_function more[] = {{"cbrt", &maths.cbrt}, {"no_function_of_this_name", &none}};
    library lacking = {.file = "libm.so.6", .functions = more, .count = 2};
    assert_int_equal(library_need(&lacking), MERLIN_DEVICE_FAILED);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(functions_can_be_called_by_every_thread_that_needs_them),
        cmocka_unit_test(a_missing_library_is_named_each_time),
        cmocka_unit_test(a_library_without_a_function_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
