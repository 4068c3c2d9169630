/* SPDX-License-Identifier: MIT */
#include "lab/eval/samples/evaluate.h"

#include <stdio.h>
#include <string.h>

#include "base/file.h"
#include "base/progress.h"
#include "estimate/surface/exposure.h"
#include "lab/eval/samples/each_sample.h"
#include "lab/eval/samples/score.h"
#include "lab/eval/samples/sheet.h"

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

/* Refuses what the network alone cannot see: merlin_estimate resizes pictures. */
static status check_raw(const sample *first)
{
    const int side = first->mask.width;
    if (side < NETWORK_LEAST_SIZE || side % MODEL_SIZE_MULTIPLE)
        return fail(MERLIN_BAD_INPUT,
                    "samples of %d pixels a side do not fit the model: the side must be a multiple of %d, from "
                    "%d on",
                    side, MODEL_SIZE_MULTIPLE, NETWORK_LEAST_SIZE);
    if (first->slant.right == 0 && first->slant.up == 0) return OK;
    return fail(MERLIN_BAD_INPUT,
                "samples rendered with --off-axis are parts of larger pictures: measure them without --raw");
}

static status open_model(evaluation *e)
{
    const eval_options *o = e->options;
    eval_report *r = e->report;
    status s = merlin_model_open(o->weights, &e->scorer.model);
    if (s != OK) return s;
    if (o->raw) network_compute_in(e->scorer.model->network, o->type);
    snprintf(r->model, sizeof r->model, "%s", merlin_model_name(e->scorer.model));
    return OK;
}

static status take_means(evaluation *e)
{
    const eval_options *o = e->options;
    eval_report *r = e->report;
    status s = o->means ? eval_means_read(o->means, r->size, r->size, &e->scorer.means)
                        : eval_means_of_folder(o->data, o->count, o->quiet, o->stopped, &e->scorer.means);
    r->means_from_data = !o->means;
    r->means_samples = e->scorer.means.samples;
    return s;
}

/* Opens what is needed; the size of all samples is that of the first. */
static status begin(void *context, const char *first_path)
{
    evaluation *e = context;
    const eval_options *o = e->options;
    sample first;
    status s = sample_read_training(first_path, &first);
    if (s != OK) return s;
    e->report->size = first.mask.width;
    s = o->raw ? check_raw(&first) : OK;
    sample_free(&first);
    if (s == OK) s = open_model(e);
    if (s == OK && o->figure) s = eval_sheet_new(o->figure_rows, &e->scorer.sheet);
    return s == OK ? take_means(e) : s;
}

static status evaluate_file(void *context, const char *path)
{
    evaluation *e = context;
    const eval_report *r = e->report;
    eval_scores scores = {0};
    sample s;
    status st = sample_read(path, &s);
    if (st != OK) return st;
    if (s.mask.width != r->size || s.mask.height != r->size)
        st = fail(MERLIN_BAD_INPUT, "%s is %dx%d but the first sample is %dx%d", path, s.mask.width, s.mask.height,
                  r->size, r->size);
    if (st == OK) st = eval_score_sample(&e->scorer, &s, &scores);
    if (st == OK) st = count_sample(e->report, &s, &scores);
    sample_free(&s);
    return st;
}

status eval_run(const eval_options *o, eval_report *out)
{
    const int views = o->views > 0 ? o->views : NETWORK_VIEWS;
    const float usual_white = o->raw ? 1 : EXPOSURE_WHITE, white = o->white > 0 ? o->white : usual_white;
    const eval_samples first = {.folder = o->data, .count = 1, .quiet = true},
                       all = {o->data, "evaluating", o->count, o->quiet, o->stopped};
    double started = clock_seconds();
    *out = (eval_report){.raw = o->raw, .views = views, .white = white, .given = o->given};
    evaluation e = {
        .options = o,
        .report = out,
        .scorer = {.raw = o->raw, .views = views, .white = white, .given = o->given, .environments = o->environments}};
    status s = o->figure ? file_check_writable(o->figure) : OK;
    if (s == OK) s = eval_each_sample(&first, begin, &e);
    if (s == OK) s = eval_each_sample(&all, evaluate_file, &e);
    if (s == OK && e.scorer.sheet) s = sheet_rows_write(e.scorer.sheet, o->figure);
    out->seconds = clock_seconds() - started;
    sheet_rows_free(e.scorer.sheet);
    eval_means_free(&e.scorer.means);
    merlin_model_close(e.scorer.model);
    return s;
}
