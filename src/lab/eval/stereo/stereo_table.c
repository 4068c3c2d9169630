/* SPDX-License-Identifier: MIT */
#include "lab/eval/stereo/stereo_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/progress.h"
#include "estimate/photo/model_pair.h"
#include "lab/eval/metrics/normal_frame.h"
#include "lab/eval/stereo/stereo_frame.h"
#include "lab/eval/stereo/stereo_object.h"
#include "lab/eval/stereo/stereo_sheet.h"
#include "merlin/surface.h"
#include "nfps/nfps_stereo.h"
#include "photo_stereo/maps_from_capture.h"
#include "photo_stereo/relit.h"
#include "photo_stereo/subsets.h"
#include "stereo/integrate/surface_error.h"

typedef struct evaluation {
    const stereo_options *options;
    merlin_model *model, *judge; /* judge: of the universal rows, or NULL */
    nfps_network *nfps;          /* of the rows of nfps, or NULL */
    merlin_relighting how;
    bool asked[STEREO_ROWS]; /* rows that are filled */
    stereo_sheet sheet;      /* its rows: NULL without a figure */
    progress bar;
    size_t solved;
} evaluation;

/* One object on its way through the rows. */
typedef struct subject {
    stereo_object object;
    relit relit;
    stereo_column *column;
    img shown[STEREO_ROWS]; /* normals of the last subset; empty for rows without */
} subject;

static void subject_free(subject *s)
{
    stereo_object_free(&s->object);
    relit_free(&s->relit);
    for (int i = 0; i < STEREO_ROWS; i++)
        img_free(&s->shown[i]);
}

/* ---- one row ---- */

static status estimate(evaluation *e, subject *s)
{
    merlin_maps maps = {0};
    status result = merlin_estimate(e->model, &s->object.photo, &s->object.capture.mask, NULL, &maps);
    if (result == OK) result = stereo_frame_check(&s->object.capture, &maps);
    if (result == OK) result = relit_new(e->model, &maps, maps.crop.side, e->how, e->options->stopped, &s->relit);
    merlin_maps_free(&maps);
    if (result == OK) result = img_copy(&s->shown[STEREO_SINGLE], &s->relit.maps.normal);
    if (result != OK) return fail_in(result, "%s", s->object.name);
    normal_frame_change(&s->shown[STEREO_SINGLE], &s->relit.capture.camera, &s->object.capture.camera);
    s->column->row[STEREO_SINGLE].error =
        normal_mean_angle(&s->shown[STEREO_SINGLE], &s->object.capture, &s->column->pixels);
    return OK;
}

static int count_draws(const stereo_options *o)
{
    return o->draws ? o->draws : SUBSETS;
}

static int count_pictures(const stereo_options *o)
{
    return o->pictures ? o->pictures : SUBSET_PICTURES;
}

/* Computes normals of a subset by a network that sees its pictures together, and photometric stereo. */
static status see_subset(const evaluation *e, const merlin_capture *from, int subset, img *normal)
{
    merlin_capture some;
    merlin_maps maps = {0};
    merlin_params params = merlin_params_default();
    params.stop = e->options->stopped;
    params.near_network = e->nfps;
    status result = subset_new(from, subset, count_pictures(e->options), &some);
    if (result != OK) return result;
    pst_capture_forget_lights(&some);
    result = merlin_maps_from_capture(e->judge, &some, &params, &maps);
    if (result == OK) {
        *normal = maps.normal;
        maps.normal = (img){0};
    }
    merlin_maps_free(&maps);
    subset_free(&some);
    return result;
}

/* Replaces the subset's lights by those that a network tells. They are near, of strengths that are known. */
static status tell_lights(const evaluation *e, merlin_capture *some)
{
    status result = lights_of_capture(e->judge, some, e->options->stopped, some->light);
    for (int k = 0; result == OK && k < some->count; k++) {
        memset(some->light[k].direction, 0, sizeof some->light[k].direction);
        some->light[k].lobe = 0;
    }
    return result;
}

/* Computes a subset's normals by the network of near lights. */
static status solve_by_nfps(const evaluation *e, const merlin_capture *from, int subset, bool told, img *normal)
{
    merlin_capture some;
    img depth = {0};
    const watch asked = {.stop = e->options->stopped};
    status result = subset_new(from, subset, count_pictures(e->options), &some);
    if (result != OK) return result;
    if (told) result = tell_lights(e, &some);
    if (result == OK)
        result = nfps_stereo(e->nfps, &some, &(nfps_options){.estimated = told, .watch = &asked}, normal, &depth);
    img_free(&depth);
    subset_free(&some);
    return result;
}

static status solve_normals(const evaluation *e, stereo_row row, const merlin_capture *from, int subset, img *normal)
{
    if (stereo_row_is_universal(row)) return see_subset(e, from, subset, normal);
    if (stereo_row_is_nfps(row)) return solve_by_nfps(e, from, subset, stereo_row_is_compared(row), normal);
    merlin_stereo_method method = row >= STEREO_RELIT_UNCALIBRATED ? MERLIN_STEREO_UNCALIBRATED : MERLIN_STEREO_AUTO;
    const merlin_stereo_params params = {.method = method, .stop = e->options->stopped};
    const pst_guide guide = nfps_guide(e->nfps);
    merlin_surface found;
    status result = subset_solve_guided(from, subset, count_pictures(e->options), &params, &guide, &found);
    if (result != OK) return result;
    *normal = found.normal;
    found.normal = (img){0};
    merlin_surface_free(&found);
    return OK;
}

static status solve_subset(const evaluation *e, subject *s, stereo_row row, const merlin_capture *from, int subset,
                           double *angle)
{
    img normal = {0};
    status result = solve_normals(e, row, from, subset, &normal);
    if (result != OK) return result;
    normal_frame_change(&normal, &from->camera, &s->object.capture.camera);
    *angle = normal_mean_angle(&normal, &s->object.capture, NULL);
    img_free(&s->shown[row]);
    s->shown[row] = normal;
    return OK;
}

/* A subset that a solver can make nothing of is a result too. */
static status solve_subsets(evaluation *e, subject *s, stereo_row row, const merlin_capture *from)
{
    stereo_score *score = &s->column->row[row];
    double sum = 0, squares = 0, angle = 0, count = 0;
    const int most = subset_count(from, count_pictures(e->options)), asked = count_draws(e->options);
    const int draws = most < asked ? most : asked;
    for (int d = 0; d < draws; d++) {
        if (e->options->stopped && e->options->stopped()) return fail(MERLIN_STOPPED, "stopped");
        status result = solve_subset(e, s, row, from, d, &angle);
        if (result != OK && result != MERLIN_BAD_INPUT) return fail_in(result, "%s", s->object.name);
        score->failed += result != OK;
        sum += result == OK ? angle : 0;
        squares += result == OK ? angle * angle : 0;
        count += result == OK;
        progress_update(&e->bar, ++e->solved, s->object.name);
    }
    score->error = count > 0 ? sum / count : NAN;
    score->spread = count > 0 ? sqrt(fmax(squares / count - score->error * score->error, 0)) : 0;
    return OK;
}

/* ---- all of them ---- */

static status evaluate_subject(evaluation *e, subject *s, const char *path)
{
    status result = stereo_object_read(path, &s->object);
    if (result != OK) return result;
    snprintf(s->column->name, sizeof s->column->name, "%s", s->object.name);
    s->column->pictures = s->object.capture.count;
    result = estimate(e, s);
    const merlin_capture *made = &s->relit.capture, *taken = &s->object.capture;
    for (int row = STEREO_RELIT; row < STEREO_ROWS; row++) {
        s->column->row[row].error = (double)NAN;
        if (result != OK || !e->asked[row]) continue;
        result = solve_subsets(e, s, (stereo_row)row, stereo_row_is_real((stereo_row)row) ? taken : made);
    }
    if (result == OK && e->sheet.rows) result = stereo_sheet_add(&e->sheet, &s->object, s->shown);
    return result;
}

static status evaluate_all(evaluation *e, char **path, stereo_table *out)
{
    status s = OK;
    int rows = 0;
    for (int row = STEREO_RELIT; row < STEREO_ROWS; row++)
        rows += e->asked[row];
    const size_t solutions = (size_t)rows * (size_t)out->draws;
    progress_begin(&e->bar, "photometric stereo", "solutions", 0, out->count * solutions, e->options->quiet);
    for (size_t i = 0; i < out->count && s == OK; i++) {
        subject one = {.column = &out->object[i]};
        s = evaluate_subject(e, &one, path[i]);
        subject_free(&one);
        e->solved = (i + 1) * solutions;
    }
    progress_end(&e->bar);
    return s;
}

/* Chooses the rows by what there is to fill them. */
static void ask(evaluation *e)
{
    for (int i = 0; i < STEREO_ROWS; i++) {
        const stereo_row row = (stereo_row)i;
        e->asked[i] = (!stereo_row_is_compared(row) || e->judge) && (!stereo_row_is_nfps(row) || e->nfps) &&
                      (!stereo_row_is_real(row) || !e->options->relit_only);
    }
}

static status run_listed(const stereo_options *options, char **path, stereo_table *out)
{
    evaluation e = {.options = options, .how = RELIT_BY};
    out->object = calloc(out->count, sizeof *out->object);
    if (!out->object) return fail(MERLIN_NO_MEMORY, "no memory for a table of %zu objects", out->count);
    status s = model_open_pair(options->weights, options->flash, &e.model);
    if (s == OK) snprintf(out->model, sizeof out->model, "%s", merlin_model_name(e.model));
    if (s == OK && network_config(e.model->network)->rival == MODEL_SANG) e.how = MERLIN_BY_NETWORK;
    if (s == OK && options->judge) s = model_open_several(options->judge, options->several, &e.judge);
    if (s == OK && options->nfps) s = nfps_network_open(options->nfps, &e.nfps);
    ask(&e);
    if (s == OK && options->figure) s = stereo_sheet_new(out->count, e.asked, &e.sheet);
    if (s == OK) s = evaluate_all(&e, path, out);
    if (s == OK && e.sheet.rows) s = sheet_rows_write(e.sheet.rows, options->figure);
    stereo_sheet_free(&e.sheet);
    merlin_model_close(e.model);
    merlin_model_close(e.judge);
    nfps_network_close(e.nfps);
    return s;
}

status stereo_table_run(const stereo_options *options, stereo_table *out)
{
    *out = (stereo_table){.draws = count_draws(options), .pictures = count_pictures(options)};
    double began = clock_seconds();
    char **path;
    size_t count;
    status s = options->figure ? file_check_writable(options->figure) : OK;
    if (s == OK) s = stereo_object_list(options->data, &path, &count);
    if (s != OK) return s;
    out->count = options->count && options->count < count ? options->count : count;
    s = run_listed(options, path, out);
    file_list_free(path, count);
    out->seconds = clock_seconds() - began;
    if (s != OK) stereo_table_free(out);
    return s;
}

void stereo_table_free(stereo_table *t)
{
    free(t->object);
    *t = (stereo_table){0};
}

/* Computes the means over the objects that were solved. */
static stereo_score mean_of(const stereo_table *t, stereo_row row)
{
    stereo_score sum = {0};
    double count = 0;
    for (size_t i = 0; i < t->count; i++) {
        if (isnan(t->object[i].row[row].error)) continue;
        sum.error += t->object[i].row[row].error;
        sum.spread += t->object[i].row[row].spread;
        count++;
    }
    return count > 0 ? (stereo_score){sum.error / count, sum.spread / count, 0} : (stereo_score){NAN, NAN, 0};
}

double stereo_table_mean(const stereo_table *t, stereo_row row)
{
    return mean_of(t, row).error;
}

double stereo_table_spread(const stereo_table *t, stereo_row row)
{
    return mean_of(t, row).spread;
}
