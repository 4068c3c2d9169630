/* SPDX-License-Identifier: MIT */
#include "evaluate_fixture.h"

/* Of setting A, where no environments are asked for. The decoder without bounces is the network's alone. */
static bool is_filled(int row, bool raw)
{
    if (row == EVAL_RELIT_NETWORK) return raw;
    return row != EVAL_SURROUNDINGS && row != EVAL_BOTH_NETWORK && row != EVAL_BOTH_BRDF &&
           row != EVAL_ENVIRONMENT_BRDF && row != EVAL_ENVIRONMENT_SHADOWS;
}

static void fill_rows(const fixture *f, bool raw)
{
    eval_options options = {
        .data = f->data, .weights = f->weights, .raw = raw, .figure = f->figure, .figure_rows = 2, .quiet = true};
    eval_report r;
    assert_int_equal(eval_run(&options, &r), OK);
    assert_int_equal(r.all.samples, SAMPLES);
    assert_int_equal(r.size, SIZE);
    assert_true(r.means_from_data);
    assert_int_equal(r.class_count, 2);
    assert_string_equal(r.class_names[1], "relief");
    assert_int_equal(r.classes[0].samples, 2);
    for (int row = 0; row < EVAL_ROWS; row++) {
        assert_int_equal(r.all.count[row][EVAL_MODEL] > 0, is_filled(row, raw));
        if (!is_filled(row, raw)) continue;
        assert_true(isfinite(eval_score(&r.all, (eval_row)row, EVAL_MODEL)));
        assert_true(isfinite(eval_score(&r.all, (eval_row)row, EVAL_MEAN)));
        assert_true(isfinite(eval_score(&r.all, (eval_row)row, EVAL_INFLATED)));
    }
    /* four lights a sample; five path-traced targets in all */
    assert_int_equal(r.all.count[EVAL_RELIT_BRDF][EVAL_MODEL], 4 * SAMPLES);
    assert_int_equal(r.all.count[EVAL_TRACED_NETWORK][EVAL_MODEL], 5);
    /* the targets of this sample are the flash picture itself */
    assert_true(fabs(eval_score(&r.all, EVAL_TRACED_BRDF, EVAL_UNCHANGED) - 1) < 1e-9);
    /* which the true maps give back, with nothing in shadow, to half floats' 0.05 % */
    assert_true(fabs(eval_score(&r.all, EVAL_TRACED_BRDF, EVAL_TRUE_MAPS) - 1) < 5e-4);
    assert_true(fabs(eval_score(&r.all, EVAL_TRACED_SHADOWS, EVAL_TRUE_MAPS) - 1) < 5e-4);
    assert_true(file_exists(f->figure));
    assert_int_equal(remove(f->figure), 0);
}

static void evaluation_fills_every_row_and_class(void **state)
{
    fill_rows(*state, false);
    fill_rows(*state, true);
}

/* Relighting has no lobes, so that there is nothing to compare with. */
static void pictures_under_leds_are_no_truth_of_relighting(void **state)
{
    const fixture *f = *state;
    char *folder = file_join(f->folder, "leds"), *path = sample_path(folder, 0);
    sample s;
    assert_int_equal(file_make_folder(folder), OK);
    write_sphere(folder, 0, SIZE, 5);
    assert_int_equal(sample_read(path, &s), OK);
    for (int i = 2; i < 5; i++) {
        s.targets[i].axis = vec3_make(0, 0, -1);
        s.targets[i].lobe = 1;
    }
    assert_int_equal(sample_write(path, &s), OK);
    eval_options options = {.data = folder, .weights = f->weights, .raw = true, .quiet = true};
    eval_report r;
    assert_int_equal(eval_run(&options, &r), OK);
    assert_int_equal(r.all.count[EVAL_TRACED_NETWORK][EVAL_MODEL], 2);
    assert_int_equal(r.all.count[EVAL_TRACED_BRDF][EVAL_TRUE_MAPS], 2);
    sample_free(&s);
    free(path);
    free(folder);
}

static void samples_are_sorted_by_how_much_of_them_is_saturated(void **state)
{
    const fixture *f = *state;
    char *folder = file_join(f->folder, "exposures");
    assert_int_equal(file_make_folder(folder), OK);
    write_lit_sphere(folder, 0, SIZE, 0,
                     0.1f); /* brightest 0.15: nothing; as it is: near the middle; all but its rim */
    write_lit_sphere(folder, 1, SIZE, 0, 1);
    write_lit_sphere(folder, 2, SIZE, 0, 1000);
    eval_options options = {.data = folder, .weights = f->weights, .raw = true, .quiet = true};
    eval_report r;
    assert_int_equal(eval_run(&options, &r), OK);
    for (int i = 0; i < EVAL_SATURATIONS; i++)
        assert_int_equal(r.saturations[i].samples, 1);
    assert_true(r.saturations[0].saturated == 0);
    assert_true(r.saturations[2].saturated > 0.95);
    assert_float_equal(r.all.saturated, r.saturations[1].saturated + r.saturations[2].saturated, 1e-12);
    /* nothing of the middle one reaches 2: the trivial answer that inverts the shading reads more of its albedo */
    double burnt = eval_score(&r.saturations[1], EVAL_ALBEDO, EVAL_INFLATED) +
                   eval_score(&r.saturations[0], EVAL_ALBEDO, EVAL_INFLATED);
    options.white = 2;
    assert_int_equal(eval_run(&options, &r), OK);
    assert_int_equal(r.saturations[0].samples, 2);
    assert_true(2 * eval_score(&r.saturations[0], EVAL_ALBEDO, EVAL_INFLATED) < burnt);
    free(folder);
}

static double all_pixels(const eval_report *r)
{
    double sum = 0;
    for (int i = 0; i < EVAL_REGIONS; i++)
        sum += (double)r->all.regions[i].pixels;
    return sum;
}

static void count_gloss(const char *path, size_t expected[EVAL_REGIONS])
{
    sample s;
    assert_int_equal(sample_read(path, &s), OK);
    const camera view = {.width = SIZE, .height = SIZE, .fov = s.fov};
    for (int i = 0; i < SIZE * SIZE; i++) {
        if (s.mask.data[i] <= 0.5f) continue;
        shade_input in = {.albedo = vec3_of(s.albedo.data + 3 * i),
                          .roughness = s.roughness.data[i],
                          .normal = vec3_of(s.normal.data + 3 * i),
                          .depth = s.depth.data[i],
                          .ray = camera_point(&view, (float)(i % SIZE) + 0.5f, (float)(i / SIZE) + 0.5f, 1),
                          .light = s.light,
                          .power = s.light_power};
        vec3 painted = shade_point(&in);
        in.albedo = vec3_make(0, 0, 0);
        float share = 3 * shade_point(&in).x / (painted.x + painted.y + painted.z);
        expected[EVAL_MATTE + (share >= 0.03f) + (share >= 0.1f) + (share >= 0.3f)]++;
    }
    sample_free(&s);
}

/* A sample's own mean weighs pixels alike, too. */
static void errors_are_sorted_by_what_a_photograph_shows(void **state)
{
    const fixture *f = *state;
    char *folder = file_join(f->folder, "gloss");
    assert_int_equal(file_make_folder(folder), OK);
    write_lit_sphere(folder, 0, SIZE, 0, 1);
    eval_options options = {.data = folder, .weights = f->weights, .raw = true, .quiet = true};
    eval_report r;
    assert_int_equal(eval_run(&options, &r), OK);
    static const eval_row maps[] = {EVAL_ALBEDO, EVAL_NORMAL, EVAL_DEPTH, EVAL_ROUGHNESS};
    for (size_t k = 0; k < 4; k++) {
        double sum = 0;
        for (int i = 0; i < EVAL_REGIONS; i++)
            sum += r.all.regions[i].sum[maps[k]][EVAL_MODEL];
        double mean = eval_score(&r.all, maps[k], EVAL_MODEL);
        assert_float_equal(sum / all_pixels(&r), mean, 1e-6 * mean);
    }
    double burnt = (double)r.all.regions[EVAL_BURNT_OUT].pixels, pixels = all_pixels(&r);
    assert_true(burnt > 0 && burnt < pixels);
    /* with nothing at its limit, by how much darker black paint would be */
    options.white = 1e4f;
    assert_int_equal(eval_run(&options, &r), OK);
    assert_int_equal(r.all.regions[EVAL_BURNT_OUT].pixels, 0);
    assert_float_equal(all_pixels(&r), pixels, 0);
    char *path = sample_path(folder, 0);
    size_t expected[EVAL_REGIONS] = {0};
    count_gloss(path, expected);
    for (int i = 0; i < EVAL_REGIONS; i++)
        assert_int_equal(r.all.regions[i].pixels, expected[i]);
    assert_true(expected[EVAL_MATTE] > 0 && expected[EVAL_MATTE + 1] > 0);
    free(path);
    free(folder);
}

static void evaluation_is_deterministic(void **state)
{
    const fixture *f = *state;
    eval_options options = {.data = f->data, .weights = f->weights, .quiet = true};
    for (int raw = 0; raw < 2; raw++) {
        char *json[2];
        options.raw = raw;
        for (int i = 0; i < 2; i++) {
            eval_report r;
            assert_int_equal(eval_run(&options, &r), OK);
            json[i] = eval_report_json(&r);
            assert_non_null(json[i]);
        }
        assert_string_equal(json[0], json[1]);
        free(json[0]);
        free(json[1]);
    }
}

/* But the decoder's where the product has it, which always sees four. */
static void more_views_change_every_figure(void **state)
{
    const fixture *f = *state;
    for (int raw = 0; raw < 2; raw++) {
        eval_options options = {.data = f->data, .weights = f->weights, .raw = raw, .views = 1, .quiet = true};
        eval_report one, eight;
        assert_int_equal(eval_run(&options, &one), OK);
        options.views = 8;
        assert_int_equal(eval_run(&options, &eight), OK);
        for (int row = 0; row < EVAL_ROWS; row++) {
            if (!one.all.count[row][EVAL_MODEL]) continue;
            double a = eval_score(&one.all, (eval_row)row, EVAL_MODEL),
                   b = eval_score(&eight.all, (eval_row)row, EVAL_MODEL);
            assert_true(isfinite(b) && a != b);
        }
    }
}

static void views_are_those_of_estimate_where_none_are_given(void **state)
{
    const fixture *f = *state;
    eval_options options = {.data = f->data, .weights = f->weights, .raw = true, .quiet = true};
    eval_report silent, given;
    assert_int_equal(eval_run(&options, &silent), OK);
    options.views = NETWORK_VIEWS;
    assert_int_equal(eval_run(&options, &given), OK);
    for (int row = 0; row < EVAL_ROWS; row++)
        if (silent.all.count[row][EVAL_MODEL])
            assert_true(eval_score(&silent.all, (eval_row)row, EVAL_MODEL) ==
                        eval_score(&given.all, (eval_row)row, EVAL_MODEL));
}

static void a_model_without_extras_leaves_its_rows_empty(void **state)
{
    const fixture *f = *state;
    model_config plain = tiny;
    plain.relight = MODEL_RELIGHT_BRDF;
    plain.feature_sharing = plain.global_illumination = false;
    char *weights = file_join(f->folder, "plain.safetensors");
    write_weights(weights, &plain);
    eval_options options = {.data = f->data, .weights = weights, .raw = true, .count = 1, .quiet = true};
    eval_report r;
    assert_int_equal(eval_run(&options, &r), OK);
    assert_int_equal(r.all.samples, 1);
    assert_true(isnan(eval_score(&r.all, EVAL_RELIT_NETWORK, EVAL_MODEL)));
    assert_false(eval_check_goal(&r.all, EVAL_RELIT_NETWORK).holds);
    assert_true(isfinite(eval_score(&r.all, EVAL_RELIT_BRDF, EVAL_MODEL)));
    free(weights);
}

static void samples_of_another_size_are_refused(void **state)
{
    const fixture *f = *state;
    char *folder = file_join(f->folder, "mixed");
    assert_int_equal(file_make_folder(folder), OK);
    eval_options options = {.data = folder, .weights = f->weights, .raw = true, .quiet = true};
    eval_report r;
    assert_int_equal(eval_run(&options, &r), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "no samples"));
    write_sphere(folder, 0, 50, 0);
    assert_int_equal(eval_run(&options, &r), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "multiple of 32"));
    options.raw = false; /* merlin estimate takes any */
    assert_int_equal(eval_run(&options, &r), OK);
    assert_int_equal(r.size, 50);
    write_sphere(folder, 0, 64, 0);
    write_sphere(folder, 1, 96, 0);
    assert_int_equal(eval_run(&options, &r), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "000001.exr"));
    free(folder);
}

static void a_figure_that_cannot_be_written_is_refused_before_the_work(void **state)
{
    const fixture *f = *state;
    char *figure = file_join(f->folder, "no/such/folder.png");
    eval_options options = {.data = "/no/data", .weights = f->weights, .figure = figure, .quiet = true};
    eval_report r;
    assert_int_equal(eval_run(&options, &r), MERLIN_CANNOT_WRITE);
    assert_non_null(strstr(status_message(), figure));
    free(figure);
}

static void a_verdict_compares_with_the_better_trivial_answer(void **state)
{
    (void)state;
    eval_scores s = {.samples = 1};
    const double albedo[EVAL_ANSWERS] = {0.06, 0.2, 0.1}, relit[EVAL_ANSWERS] = {0.95, 0.8, 0.7, 0.92};
    for (int a = 0; a < EVAL_ANSWERS; a++) {
        if (a != EVAL_UNCHANGED) s.count[EVAL_ALBEDO][a] = 1;
        s.sum[EVAL_ALBEDO][a] = albedo[a];
        s.count[EVAL_RELIT_BRDF][a] = 1;
        s.sum[EVAL_RELIT_BRDF][a] = relit[a];
    }
    eval_verdict v = eval_check_goal(&s, EVAL_ALBEDO);
    assert_true(fabs(v.ratio - 0.6) < 1e-12);
    v = eval_check_goal(&s, EVAL_RELIT_BRDF);
    assert_true(fabs(v.margin - 0.03) < 1e-12);
    assert_false(v.holds);
    s.sum[EVAL_RELIT_BRDF][EVAL_MODEL] = 0.98; /* against 0.92 */
    assert_true(eval_check_goal(&s, EVAL_RELIT_BRDF).holds);
    assert_false(eval_check_goal(&s, EVAL_ROUGHNESS).holds); /* no figures at all */
}

/* The mean maps of a single sample are the sample itself. */
static void an_error_beside_none_has_no_ratio(void **state)
{
    (void)state;
    eval_report r = {.all = {.samples = 1}, .class_count = 1, .class_names = {"union"}};
    r.all.count[EVAL_ALBEDO][EVAL_MODEL] = r.all.count[EVAL_ALBEDO][EVAL_MEAN] = 1;
    r.all.sum[EVAL_ALBEDO][EVAL_MODEL] = 0.06;
    r.classes[0] = r.all;
    assert_true(isnan(eval_check_goal(&r.all, EVAL_ALBEDO).ratio));
    assert_false(eval_check_goal(&r.all, EVAL_ALBEDO).holds);
    char *json = eval_report_json(&r), *table;
    size_t size;
    FILE *stream = open_memstream(&table, &size);
    assert_non_null(json);
    assert_non_null(stream);
    eval_print_table(&r, stream);
    fclose(stream);
    assert_null(strstr(json, "null"));
    assert_null(strstr(json, "ratio"));
    assert_null(strstr(table, "inf "));
    assert_null(strstr(table, "(inf)"));
    assert_null(strstr(table, "nan"));
    free(json);
    free(table);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(evaluation_fills_every_row_and_class),
        cmocka_unit_test(pictures_under_leds_are_no_truth_of_relighting),
        cmocka_unit_test(samples_are_sorted_by_how_much_of_them_is_saturated),
        cmocka_unit_test(errors_are_sorted_by_what_a_photograph_shows),
        cmocka_unit_test(evaluation_is_deterministic),
        cmocka_unit_test(more_views_change_every_figure),
        cmocka_unit_test(views_are_those_of_estimate_where_none_are_given),
        cmocka_unit_test(a_model_without_extras_leaves_its_rows_empty),
        cmocka_unit_test(samples_of_another_size_are_refused),
        cmocka_unit_test(a_figure_that_cannot_be_written_is_refused_before_the_work),
        cmocka_unit_test(an_error_beside_none_has_no_ratio),
        cmocka_unit_test(a_verdict_compares_with_the_better_trivial_answer),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
