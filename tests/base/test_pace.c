/* SPDX-License-Identifier: MIT */
/* Estimates of the time left, from the speed so far. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include "base/progress.h"

#include <cmocka.h>

static void assert_near(double value, double expected, double within)
{
    print_message("%.4f, expected %.4f\n", value, expected);
    assert_true(fabs(value - expected) <= within);
}

static void nothing_is_promised_before_anything_is_heard_of(void **state)
{
    (void)state;
    pace p;
    pace_begin(&p, 0.3, 100);
    assert_true(pace_left(&p, 105) < 0);
    pace_note(&p, 0.3, 106); /* not above the last share */
    assert_true(pace_left(&p, 106) < 0);
}

static void an_even_pace_is_told_exactly(void **state)
{
    (void)state;
    pace p;
    pace_begin(&p, 0, 100);
    for (int i = 1; i <= 10; i++) {
        pace_note(&p, i / 10.0, 100 + 3 * i);
        assert_near(pace_left(&p, 100 + 3 * i), 3 * (10 - i), 1e-9);
    }
}

static void what_was_done_before_the_beginning_is_no_speed(void **state)
{
    (void)state;
    pace p;
    pace_begin(&p, 0.5, 0);
    pace_note(&p, 0.6, 10);
    assert_near(pace_left(&p, 10), 40, 1e-9);
}

static void time_passes_while_nothing_is_heard_of(void **state)
{
    (void)state;
    pace p;
    pace_begin(&p, 0, 0);
    pace_note(&p, 0.5, 10);
    assert_near(pace_left(&p, 14), 6, 1e-9);
    assert_near(pace_left(&p, 25), 0, 0);
    pace_note(&p, 0.5, 26);
    pace_note(&p, 0.4, 27); /* a smaller share is ignored, too */
    assert_near(pace_left(&p, 27), 0, 0);
    pace_note(&p, 0.75, 30); /* the time since the last note counts: 20 s for a quarter after 10 s for a half */
    assert_true(pace_left(&p, 30) > 10 && pace_left(&p, 30) < 20);
}

static void the_latest_pace_weighs_most(void **state)
{
    (void)state;
    pace p;
    double now = 0;
    pace_begin(&p, 0, now);
    for (int i = 1; i <= 50; i++)
        pace_note(&p, i / 100.0, now += 1);
    for (int i = 51; i <= 90; i++)
        pace_note(&p, i / 100.0, now += 4);
    /* 10 hundredths at 4 s are left; the mean of all the work would give 23 s */
    double left = pace_left(&p, now);
    print_message("%.2f s left\n", left);
    assert_true(left > 28 && left < 40);
}

static void one_hasty_step_changes_little(void **state)
{
    (void)state;
    pace p;
    double now = 0;
    pace_begin(&p, 0, now);
    for (int i = 1; i <= 50; i++)
        pace_note(&p, i / 100.0, now += 1);
    pace_note(&p, 0.51, now += 0.01);
    assert_near(pace_left(&p, now), 49, 3);
}

static void all_of_it_leaves_nothing(void **state)
{
    (void)state;
    pace p;
    pace_begin(&p, 0, 0);
    pace_note(&p, 1, 5);
    assert_near(pace_left(&p, 5), 0, 0);
}

static void times_are_read_as_clocks_are(void **state)
{
    (void)state;
    char text[PROGRESS_TIME];
    progress_time(7.4, text);
    assert_string_equal(text, "0:07");
    progress_time(59.6, text);
    assert_string_equal(text, "1:00");
    progress_time(3723, text);
    assert_string_equal(text, "1:02:03");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_is_promised_before_anything_is_heard_of),
        cmocka_unit_test(an_even_pace_is_told_exactly),
        cmocka_unit_test(what_was_done_before_the_beginning_is_no_speed),
        cmocka_unit_test(time_passes_while_nothing_is_heard_of),
        cmocka_unit_test(the_latest_pace_weighs_most),
        cmocka_unit_test(one_hasty_step_changes_little),
        cmocka_unit_test(all_of_it_leaves_nothing),
        cmocka_unit_test(times_are_read_as_clocks_are),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
