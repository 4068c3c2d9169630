/* SPDX-License-Identifier: MIT */
/* Whoever waits for a solver hears how far it is. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

#include "relief.h"

typedef struct heard {
    int count;
    float last;
} heard;

static void hear(void *context, const char *stage, float share)
{
    heard *h = context;
    assert_string_equal(stage, "solving");
    assert_true(share >= h->last && share <= 1);
    h->last = share;
    h->count++;
}

static void a_solver_tells_how_far_it_is_and_finds_the_same(void **state)
{
    (void)state;
    const relief how = {
        .size = 96, .lights = 20, .channels = 1, .bump = 4, .specular = 0.5f, .roughness = 0.3f, .exposure = 1};
    static const merlin_stereo_method methods[] = {MERLIN_STEREO_LS, MERLIN_STEREO_ROBUST, MERLIN_STEREO_SEMI,
                                                   MERLIN_STEREO_UNCALIBRATED};
    merlin_capture c;
    relief_capture(&how, &c);
    for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
        heard h = {0};
        merlin_surface watched, alone;
        assert_int_equal(
            pst_solve(&c, &(merlin_stereo_params){.method = methods[i], .progress = hear, .progress_context = &h},
                      &watched),
            OK);
        assert_int_equal(pst_solve(&c, &(merlin_stereo_params){.method = methods[i]}, &alone), OK);
        assert_memory_equal(watched.normal.data, alone.normal.data, img_value_count(&alone.normal) * sizeof(float));
        if (methods[i] != MERLIN_STEREO_LS) {
            print_message("%s: told %d times, to %.2f\n", merlin_stereo_method_name(methods[i]), h.count,
                          (double)h.last);
            assert_true(h.count > 20 && h.last > 0.6f);
        }
        merlin_surface_free(&watched);
        merlin_surface_free(&alone);
    }
    capture_drop(&c);
}

static void count(void *context, const char *stage, float share)
{
    (void)stage;
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
    static const merlin_stereo_method methods[] = {MERLIN_STEREO_ROBUST, MERLIN_STEREO_SEMI,
                                                   MERLIN_STEREO_UNCALIBRATED};
    int told = 0;
    merlin_stereo_params params = {
        .keep_edges = 1, .integrate = 1, .stop = give_up, .progress = count, .progress_context = &told};
    merlin_capture c;
    merlin_surface found;
    relief_capture(&how, &c);
    for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
        params.method = methods[i];
        assert_int_equal(pst_solve(&c, &params, &found), MERLIN_STOPPED);
    }
    assert_int_equal(pst_solve(&c, &(merlin_stereo_params){.method = MERLIN_STEREO_LS}, &found), OK);
    assert_int_equal(pst_surface_integrate(&params, &found), MERLIN_STOPPED);
    params.stop = NULL;
    assert_int_equal(pst_surface_integrate(&params, &found), OK);
    assert_true(told > 0);
    merlin_surface_free(&found);
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
