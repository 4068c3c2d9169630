/* SPDX-License-Identifier: MIT */
/* Whoever waits for a solver hears how far it is. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

#include <cmocka.h> /* behind ours: it has a macro named fail */

#include "relief.h"

typedef struct heard {
    int count;
    float last;
} heard;

static void hear(void *context, const char *what, float share)
{
    heard *h = context;
    assert_string_equal(what, "solving");
    assert_true(share >= h->last && share <= 1);
    h->last = share;
    h->count++;
}

static void a_solver_tells_how_far_it_is_and_finds_the_same(void **state)
{
    (void)state;
    const relief how = {
        .size = 96, .lights = 20, .channels = 1, .bump = 4, .specular = 0.5f, .roughness = 0.3f, .exposure = 1};
    static const pst_method methods[] = {PST_LS, PST_ROBUST, PST_SEMI, PST_UNCALIBRATED};
    pst_capture c;
    relief_capture(&how, &c);
    for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
        heard h = {0};
        watch w = {.tell = hear, .context = &h};
        pst_surface watched, alone;
        assert_int_equal(pst_solve(&c, &(pst_options){.method = methods[i], .watch = &w}, &watched), OK);
        assert_int_equal(pst_solve(&c, &(pst_options){.method = methods[i]}, &alone), OK);
        assert_memory_equal(watched.normal.data, alone.normal.data, img_value_count(&alone.normal) * sizeof(float));
        if (methods[i] != PST_LS) {
            print_message("%s: told %d times, to %.2f\n", pst_method_name(methods[i]), h.count, (double)h.last);
            assert_true(h.count > 20 && h.last > 0.6f);
        }
        pst_surface_free(&watched);
        pst_surface_free(&alone);
    }
    capture_drop(&c);
}

static void ignore(void *context, const char *what, float share)
{
    (void)what;
    (void)share;
    (*(int *)context)++;
}

static int give_up(void)
{
    return 1;
}

static void work_that_nobody_waits_for_any_more_stops(void **state)
{
    (void)state;
    const relief how = {
        .size = 96, .lights = 20, .channels = 1, .bump = 4, .specular = 0.5f, .roughness = 0.3f, .exposure = 1};
    static const pst_method methods[] = {PST_ROBUST, PST_SEMI, PST_UNCALIBRATED};
    int told = 0;
    const watch w = {ignore, &told, give_up};
    pst_capture c;
    pst_surface found;
    relief_capture(&how, &c);
    for (size_t i = 0; i < sizeof methods / sizeof *methods; i++)
        assert_int_equal(pst_solve(&c, &(pst_options){.method = methods[i], .watch = &w}, &found), MERLIN_STOPPED);
    assert_int_equal(pst_solve(&c, &(pst_options){.method = PST_LS}, &found), OK);
    assert_int_equal(pst_surface_integrate(&c, true, true, &w, &found), MERLIN_STOPPED);
    assert_int_equal(pst_surface_integrate(&c, true, true, NULL, &found), OK);
    assert_true(told > 0);
    pst_surface_free(&found);
    capture_drop(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_solver_tells_how_far_it_is_and_finds_the_same),
        cmocka_unit_test(work_that_nobody_waits_for_any_more_stops),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
