/* SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <unistd.h>

#include "../../estimate/weights.h"
#include "base/file.h"
#include "estimate/photo/network.h"
#include "lab/eval/evaluate.h"
#include "lab/eval/report.h"
#include "lab/eval/truth.h"
#include "lab/render/generate.h"
#include "scratch.h"
#include "sphere.h"

#include <cmocka.h> /* behind ours: it has a macro named fail */

enum { SIZE = 64, SAMPLES = 3 };

static const model_config tiny = {.name = "tiny",
                                  .input_global = true,
                                  .material_decoders = 1,
                                  .feature_sharing = true,
                                  .gated_attention = true,
                                  .relight = MODEL_RELIGHT_NETWORK,
                                  .global_illumination = true,
                                  .lighting = MODEL_LIGHT_POINT,
                                  .widths = {8, 8, 8, 8, 8},
                                  .gi_widths = {8, 8, 8, 8, 8}};

static void write_weights(const char *path, const model_config *config)
{
    nn_graph *g;
    nn_params *params;
    char *json = model_config_write(config);
    assert_int_equal(model_build(config, MODEL_WHOLE, &g), OK);
    assert_int_equal(nn_params_new(g, 7, &params), OK);
    assert_int_equal(write_params(path, params, json), OK);
    free(json);
    nn_params_free(params);
    nn_graph_free(g);
}

typedef struct fixture {
    char *folder, *data, *weights, *figure;
} fixture;

/* light: of the flash picture, times what the sphere is lit with. */
static void write_lit_sphere(const char *folder, int index, int size, int targets, float light)
{
    sphere of = {{0.05f * (float)index, 0, -1.2f}, 0.4f, {0.2f + 0.2f * (float)index, 0.5f, 0.4f}, 0.5f, size};
    sample s;
    assert_int_equal(sphere_sample(&of, targets, &s), OK);
    s.index = (uint64_t)index;
    for (int c = 0; c < 3; c++)
        s.sh[0][c] = (float)(index + 1); /* even surroundings, brighter from one to the next */
    for (int i = 0; i < 3 * size * size; i++)
        s.direct.data[i] *= light;
    strcpy(s.shape, index == 2 ? "relief" : "union");
    char *path = sample_path(folder, s.index);
    assert_int_equal(sample_write(path, &s), OK);
    free(path);
    sample_free(&s);
}

static void write_sphere(const char *folder, int index, int size, int targets)
{
    write_lit_sphere(folder, index, size, targets, 1);
}

static int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    assert_non_null(f);
    f->folder = scratch_new();
    f->data = file_join(f->folder, "data");
    f->weights = file_join(f->folder, "tiny.safetensors");
    f->figure = file_join(f->folder, "sheet.png");
    assert_int_equal(file_make_folder(f->data), OK);
    for (int i = 0; i < SAMPLES; i++)
        write_sphere(f->data, i, SIZE, i == 0 ? 5 : 0);
    write_weights(f->weights, &tiny);
    *state = f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    scratch_remove(f->folder);
    free(f->data);
    free(f->weights);
    free(f->figure);
    free(f);
    return 0;
}

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
    assert_false(eval_judge(&r.all, EVAL_RELIT_NETWORK).holds);
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
    eval_verdict v = eval_judge(&s, EVAL_ALBEDO);
    assert_true(fabs(v.ratio - 0.6) < 1e-12);
    v = eval_judge(&s, EVAL_RELIT_BRDF);
    assert_true(fabs(v.margin - 0.03) < 1e-12);
    assert_false(v.holds);
    s.sum[EVAL_RELIT_BRDF][EVAL_MODEL] = 0.98; /* against 0.92 */
    assert_true(eval_judge(&s, EVAL_RELIT_BRDF).holds);
    assert_false(eval_judge(&s, EVAL_ROUGHNESS).holds); /* no figures at all */
}

/* The mean maps of a single sample are the sample itself. */
static void an_error_beside_none_has_no_ratio(void **state)
{
    (void)state;
    eval_report r = {.all = {.samples = 1}, .class_count = 1, .class_names = {"union"}};
    r.all.count[EVAL_ALBEDO][EVAL_MODEL] = r.all.count[EVAL_ALBEDO][EVAL_MEAN] = 1;
    r.all.sum[EVAL_ALBEDO][EVAL_MODEL] = 0.06;
    r.classes[0] = r.all;
    assert_true(isnan(eval_judge(&r.all, EVAL_ALBEDO).ratio));
    assert_false(eval_judge(&r.all, EVAL_ALBEDO).holds);
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
        cmocka_unit_test(evaluation_fills_every_row_and_class),
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
        cmocka_unit_test(even_surroundings_show_the_albedo),
        cmocka_unit_test(relighting_by_environments_is_measured_on_the_first_samples),
        cmocka_unit_test(objects_that_cannot_be_rendered_again_are_not_relit),
        cmocka_unit_test(models_of_both_lights_are_shown_the_environment_too),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
