/* SPDX-License-Identifier: MIT */
/* merlin_stereo_from_maps of include/merlin/surface.h, by a model of random weights. */
#include "../estimate/estimate_fixture.h"
#include "each_allocation.h"

static int always(void)
{
    return 1;
}

static void a_photograph_gives_a_surface_of_its_square(void **state)
{
    const fixture *f = *state;
    merlin_maps maps;
    merlin_surface s;
    estimate(f, &maps);
    if (merlin_stereo_from_maps(f->model, &maps, NULL, &s) != MERLIN_OK) fail_msg("%s", merlin_error());
    assert_int_equal(s.mask.width, maps.crop.side);
    assert_int_equal(s.method, MERLIN_STEREO_NEAR);
    assert_int_equal(s.relit.lights, 50);
    assert_string_equal(s.relit.model, merlin_model_name(f->model));
    assert_true(s.relit.pixels > 1000 && s.relit.pixels_left < s.relit.pixels);
    for (int i = 0; i < s.mask.width * s.mask.height; i++) {
        const float *n = s.normal.data + 3 * i;
        if (s.mask.data[i] == 0) continue;
        assert_float_equal(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1, 1e-4);
        assert_true(isfinite(s.depth.data[i]) && s.residual.data[i] >= 0);
    }
    merlin_surface_free(&s);
    merlin_maps_free(&maps);
}

static void what_is_no_photograph_is_refused(void **state)
{
    const fixture *f = *state;
    merlin_maps maps;
    merlin_surface s;
    estimate(f, &maps);
    assert_int_equal(merlin_stereo_from_maps(f->model, &maps, &(merlin_stereo_params){.method = MERLIN_STEREO_LS}, &s),
                     MERLIN_WRONG_USE);
    assert_int_equal(merlin_stereo_from_maps(f->model, &maps, &(merlin_stereo_params){.stop = always}, &s),
                     MERLIN_STOPPED);
    assert_null(s.normal.data);
    maps.captured = 1;
    assert_int_equal(merlin_stereo_from_maps(f->model, &maps, NULL, &s), MERLIN_WRONG_USE);
    merlin_image picture;
    const float light[3] = {0, 0, 0};
    assert_int_equal(merlin_relight(f->model, &maps, light, MERLIN_BY_NETWORK, &picture), MERLIN_WRONG_USE);
    assert_int_equal(merlin_relight(f->model, &maps, light, MERLIN_BY_BRDF, &picture), MERLIN_OK);
    merlin_image_free(&picture);
    merlin_maps_free(&maps);
    assert_int_equal(merlin_stereo_from_maps(f->model, &maps, NULL, &s), MERLIN_WRONG_USE);
}

/* ---- lack of memory ---- */

typedef struct work {
    merlin_model *model;
    merlin_maps maps;
    merlin_surface made;
} work;

static int solve(void *context)
{
    work *w = context;
    memset(&w->made, 1, sizeof w->made);
    return merlin_stereo_from_maps(w->model, &w->maps, NULL, &w->made);
}

static const char *check(void *context, int result)
{
    work *w = context;
    const char *fault = NULL;
    for (size_t i = 0; result != MERLIN_OK && i < sizeof w->made; i++)
        if (((const char *)&w->made)[i]) return "a surface after a failure";
    if (result == MERLIN_OK && w->made.relit.lights != 50) fault = "a surface without its lights";
    merlin_surface_free(&w->made);
    return fault;
}

/* Returns the photograph without all but every STEP-th row and column, which are solved sooner. */
static merlin_image fewer_pixels(const merlin_image *image)
{
    enum { STEP = 5 };
    merlin_image fewer = image_new(WIDTH / STEP, HEIGHT / STEP, image->channels);
    for (int i = 0; i < fewer.width * fewer.height; i++)
        for (int c = 0; c < fewer.channels; c++) {
            int from = i / fewer.width * STEP * WIDTH + i % fewer.width * STEP;
            fewer.data[fewer.channels * i + c] = image->data[fewer.channels * from + c];
        }
    return fewer;
}

static void lack_of_memory_gives_no_surface(void **state)
{
    const fixture *f = *state;
    work w = {.model = f->model};
    const merlin_params p = small();
    merlin_image photo = fewer_pixels(&f->photo), mask = fewer_pixels(&f->mask);
    if (merlin_estimate(f->model, &photo, &mask, &p, &w.maps) != MERLIN_OK) fail_msg("%s", merlin_error());
    merlin_set_threads(1); /* the n-th allocation is the same one each time */
    some_allocations_fail(&(memory_trial){"stereo from maps", solve, check, &w}, 12);
    merlin_maps_free(&w.maps);
    merlin_image_free(&photo);
    merlin_image_free(&mask);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_photograph_gives_a_surface_of_its_square),
        cmocka_unit_test(what_is_no_photograph_is_refused),
        cmocka_unit_test(lack_of_memory_gives_no_surface),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
