/* SPDX-License-Identifier: MIT */
/* Evaluation of models of both lights: a flash and surroundings. */
#include "evaluate_fixture.h"

/* By a lamp so far away that it gives nothing. */
static void even_surroundings_show_the_albedo(void **state)
{
    (void)state;
    sphere of = {{0, 0, -1}, 0.3f, {0.2f, 0.5f, 0.8f}, 0.5f, 64};
    sample s;
    surface maps;
    img lit;
    assert_int_equal(sphere_sample(&of, 0, &s), OK);
    assert_int_equal(eval_truth(&s, &s.mask, &maps), OK);
    float radiance = 0.7f, even[9][3] = {0};
    for (int c = 0; c < 3; c++)
        even[0][c] = radiance / 0.28209479f;
    illumination surroundings = {{0, 0, 1e6f}, (const float(*)[3])even};
    for (int half = 0; half < 2; half++) {
        const float exposure = half ? 0.5f : 1;
        assert_int_equal(eval_render(&maps, &surroundings, exposure, &lit), OK);
        for (int c = 0; c < 3; c++)
            assert_float_equal(img_at(&lit, 32, 32)[c], exposure * radiance * of.albedo[c], 1e-5);
        assert_float_equal(img_at(&lit, 0, 0)[0], 0, 0);
        img_free(&lit);
    }
    surface_free(&maps);
    sample_free(&s);
}

static void remove_environments(const char *folder)
{
    for (uint64_t i = 0; i < SAMPLES; i++) {
        char *path = sample_path(folder, i);
        sample s;
        assert_int_equal(sample_read(path, &s), OK);
        img_free(&s.env);
        assert_int_equal(sample_write(path, &s), OK);
        sample_free(&s);
        free(path);
    }
}

static void models_of_both_lights_are_shown_the_environment_too(void **state)
{
    const fixture *f = *state;
    model_config both = tiny;
    both.lighting = MODEL_LIGHT_BOTH;
    write_weights(f->weights, &both);
    eval_options options = {.data = f->data, .weights = f->weights, .quiet = true};
    eval_report r;
    assert_int_equal(eval_run(&options, &r), OK);
    assert_true(isfinite(eval_score(&r.all, EVAL_SURROUNDINGS, EVAL_MODEL)));
    assert_int_equal(r.all.count[EVAL_BOTH_BRDF][EVAL_MODEL], 4 * SAMPLES);
    assert_int_equal(r.all.count[EVAL_BOTH_NETWORK][EVAL_MODEL], 0);
    options.raw = true;
    assert_int_equal(eval_run(&options, &r), OK);
    assert_true(isfinite(eval_score(&r.all, EVAL_RECONSTRUCTION, EVAL_MODEL)));
    assert_int_equal(r.all.count[EVAL_RELIT_NETWORK][EVAL_MODEL], 4 * SAMPLES);
    assert_int_equal(r.all.count[EVAL_BOTH_NETWORK][EVAL_MODEL], 4 * SAMPLES);
    assert_int_equal(r.all.count[EVAL_BOTH_BRDF][EVAL_INFLATED], 4 * SAMPLES);
    /* 1, 2 and 3 times Y00, at 0.316 of their strength: the mean is off by 1, 0 and 1 */
    assert_true(isfinite(eval_score(&r.all, EVAL_SURROUNDINGS, EVAL_MODEL)));
    double one = 0.316 * 0.28209479;
    assert_float_equal(eval_score(&r.all, EVAL_SURROUNDINGS, EVAL_MEAN), 2 * one * one / 3, 1e-7);
    remove_environments(f->data);
    assert_int_equal(eval_run(&options, &r), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "--no-env"));
}

/* Samples 8 and 9 of seed 4242 are folded: a block with relief and a cloth over a ball. */
static void relighting_by_environments_is_measured_on_the_first_samples(void **state)
{
    const fixture *f = *state;
    render_options made = render_options_default();
    render_stats stats;
    char *folder = file_join(f->folder, "folded");
    made.folder = folder;
    made.seed = 4242;
    made.first = 8;
    made.count = 2;
    made.image.size = SIZE;
    made.environment = false; /* its own is not what it is relit by */
    made.quiet = true;
    assert_int_equal(render_samples(&made, &stats), OK);
    eval_options options = {.data = folder, .weights = f->weights, .environments = 1, .quiet = true};
    eval_report r;
    assert_int_equal(eval_run(&options, &r), OK);
    assert_int_equal(r.all.samples, 2);
    for (int row = EVAL_ENVIRONMENT_BRDF; row <= EVAL_ENVIRONMENT_SHADOWS; row++)
        for (int answer = 0; answer < EVAL_ANSWERS; answer++) {
            assert_int_equal(r.all.count[row][answer], 1);
            assert_true(isfinite(eval_score(&r.all, (eval_row)row, (eval_answer)answer)));
        }
    double without = eval_score(&r.all, EVAL_ENVIRONMENT_BRDF, EVAL_TRUE_MAPS);
    double with = eval_score(&r.all, EVAL_ENVIRONMENT_SHADOWS, EVAL_TRUE_MAPS);
    print_message("true maps: without shadows %.4f, with %.4f\n", without, with);
    /* what is left is the path tracer's grain and three bands for diffuse light: test_environment_truth has more */
    assert_true(with > 0.9 && with > without);
    free(folder);
}

static void objects_that_cannot_be_rendered_again_are_not_relit(void **state)
{
    const fixture *f = *state;
    eval_options options = {.data = f->data, .weights = f->weights, .environments = 1, .quiet = true};
    eval_report r;
    assert_int_equal(eval_run(&options, &r), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "cannot be relit by environments"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(even_surroundings_show_the_albedo),
        cmocka_unit_test(relighting_by_environments_is_measured_on_the_first_samples),
        cmocka_unit_test(objects_that_cannot_be_rendered_again_are_not_relit),
        cmocka_unit_test(models_of_both_lights_are_shown_the_environment_too),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
