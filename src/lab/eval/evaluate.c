/* SPDX-License-Identifier: MIT */
#include "lab/eval/evaluate.h"

#include <math.h>
#include <string.h>

#include "base/file.h"
#include "base/progress.h"
#include "estimate/photo/network.h"
#include "lab/eval/score.h"

typedef struct evaluation {
    const eval_options *options;
    eval_scorer scorer;
    eval_report *report;
} evaluation;

static void add_region(eval_region *to, const eval_region *from)
{
    to->pixels += from->pixels;
    for (int map = 0; map <= EVAL_ROUGHNESS; map++)
        for (int answer = 0; answer <= EVAL_INFLATED; answer++)
            to->sum[map][answer] += from->sum[map][answer];
}

static void add_scores(eval_scores *to, const eval_scores *from)
{
    for (int row = 0; row < EVAL_ROWS; row++) {
        for (int answer = 0; answer < EVAL_ANSWERS; answer++) {
            to->sum[row][answer] += from->sum[row][answer];
            to->count[row][answer] += from->count[row][answer];
        }
    }
    for (int i = 0; i < EVAL_REGIONS; i++)
        add_region(&to->regions[i], &from->regions[i]);
    to->samples++;
    to->saturated += from->saturated;
}

static status count_sample(eval_report *report, const sample *s, const eval_scores *scores)
{
    int c = 0;
    while (c < report->class_count && strcmp(report->class_names[c], s->shape) != 0)
        c++;
    if (c == EVAL_MAX_CLASSES) return fail(MERLIN_BAD_INPUT, "more than %d classes of shape", EVAL_MAX_CLASSES);
    if (c == report->class_count) {
        memcpy(report->class_names[c], s->shape, sizeof report->class_names[c]);
        report->class_count++;
    }
    add_scores(&report->classes[c], scores);
    add_scores(&report->saturations[(scores->saturated >= 0.1) + (scores->saturated >= 0.4)], scores);
    add_scores(&report->all, scores);
    return OK;
}

static status evaluate_file(evaluation *e, const char *path)
{
    sample s;
    status st = sample_read(path, &s);
    if (st != OK) return st;
    eval_scores scores = {0};
    if (s.mask.width != e->report->size || s.mask.height != e->report->size)
        st = fail(MERLIN_BAD_INPUT, "%s is %dx%d but the first sample is %dx%d", path, s.mask.width, s.mask.height,
                  e->report->size, e->report->size);
    if (st == OK) st = eval_score_sample(&e->scorer, &s, &scores);
    if (st == OK) st = count_sample(e->report, &s, &scores);
    sample_free(&s);
    return st;
}

/* The size of all samples is that of the first. */
static status begin(evaluation *e, const char *first_path)
{
    const eval_options *o = e->options;
    sample first;
    status s = sample_read_training(first_path, &first);
    if (s != OK) return s;
    e->report->size = first.mask.width;
    e->scorer.environments = o->environments;
    e->scorer.white = e->report->white = o->white > 0 ? o->white : 1;
    e->scorer.given = e->report->given = o->given;
    sample_free(&first);
    e->report->views = o->views > 0 ? o->views : NETWORK_VIEWS;
    s = eval_model_open(o->weights, e->report->size, o->type, e->report->views, &e->scorer.model);
    if (s == OK) s = eval_prediction_new(e->scorer.model, &e->scorer.prediction);
    if (s == OK && o->figure) s = eval_sheet_new(o->figure_rows, &e->scorer.sheet);
    if (s != OK) return s;
    e->report->means_from_data = !o->means;
    if (o->means)
        s = eval_means_read(o->means, e->report->size, e->report->size, &e->scorer.means);
    else
        s = eval_means_of_folder(o->data, o->count, o->quiet, o->stopped, &e->scorer.means);
    e->report->means_samples = e->scorer.means.samples;
    memcpy(e->report->model, eval_model_config(e->scorer.model)->name, sizeof e->report->model);
    return s;
}

static status evaluate_files(evaluation *e, char **names, size_t count)
{
    progress p;
    status s = OK;
    progress_begin(&p, "evaluating", "samples", 0, count, e->options->quiet);
    for (size_t i = 0; s == OK && i < count; i++) {
        if (e->options->stopped && e->options->stopped())
            s = fail(MERLIN_STOPPED, "stopped after %zu of %zu samples", i, count);
        else
            s = evaluate_file(e, names[i]);
        if (s == OK) progress_update(&p, i + 1, NULL);
    }
    progress_end(&p);
    return s;
}

status eval_run(const eval_options *options, eval_report *out)
{
    *out = (eval_report){0};
    evaluation e = {.options = options, .report = out};
    double started = clock_seconds();
    char **names;
    size_t count;
    status s = options->figure ? file_check_writable(options->figure) : OK;
    if (s == OK) s = sample_list(options->data, &names, &count);
    if (s != OK) return s;
    size_t used = options->count && options->count < count ? options->count : count;
    s = begin(&e, names[0]);
    if (s == OK) s = evaluate_files(&e, names, used);
    if (s == OK && e.scorer.sheet) s = sheet_rows_write(e.scorer.sheet, options->figure);
    out->seconds = clock_seconds() - started;
    sheet_rows_free(e.scorer.sheet);
    eval_prediction_free(&e.scorer.prediction);
    eval_means_free(&e.scorer.means);
    eval_model_close(e.scorer.model);
    file_list_free(names, count);
    return s;
}
