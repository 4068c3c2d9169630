/* SPDX-License-Identifier: MIT */
#include "lab/eval/paper/paper_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/progress.h"
#include "lab/eval/samples/evaluate.h"
#include "model/model.h"

/* Counts a model's parameters and its multiply-adds at 256×256, from a small picture's. */
static status count_cost(const char *weights, paper_row *row)
{
    enum { SMALL = 64, USUAL = 256 };
    const double ratio = (double)USUAL / SMALL;
    model_config config;
    nn_graph *g = NULL;
    nn_params *params = NULL;
    nn_program *p = NULL;
    const nn_options options = {.batch = 1, .height = SMALL, .width = SMALL, .type = NN_FLOAT32, .purpose = NN_INFER};
    status s = model_load(weights, &config, &params);
    if (s == OK) s = model_build(&config, MODEL_WHOLE, &g);
    if (s == OK) s = nn_compile(g, params, &options, &p);
    if (s == OK) {
        const nn_cost cost = nn_program_cost(p);
        row->parameters = (double)cost.parameter_count;
        row->multiply_adds = cost.forward_flops / 2 * ratio * ratio;
    }
    nn_program_free(p);
    nn_params_free(params);
    nn_graph_free(g);
    return s;
}

static paper_row *row_of(paper_table *t, const char *model)
{
    for (int i = 0; i < t->rows; i++)
        if (strcmp(t->row[i].model, model) == 0) return &t->row[i];
    paper_row *row = &t->row[t->rows++];
    *row = (paper_row){.runs = 0};
    snprintf(row->model, sizeof row->model, "%s", model);
    return row;
}

/* Adds a run; spread is the sum of squares until all are there. */
static void add_run(paper_row *row, const eval_scores *scores)
{
    static const eval_row of[PAPER_COLUMNS] = {EVAL_ALBEDO, EVAL_ROUGHNESS,     EVAL_NORMAL,
                                               EVAL_DEPTH,  EVAL_RELIT_NETWORK, EVAL_RELIT_BRDF};
    for (int i = 0; i < PAPER_COLUMNS; i++) {
        const double value = eval_score(scores, of[i], EVAL_MODEL);
        row->mean[i] += value;
        row->spread[i] += value * value;
    }
    row->runs++;
}

static void finish(paper_row *row)
{
    const double n = row->runs;
    for (int i = 0; i < PAPER_COLUMNS; i++) {
        row->mean[i] /= n;
        const double rest = row->spread[i] - n * row->mean[i] * row->mean[i];
        row->spread[i] = row->runs > 1 ? sqrt(fmax(rest, 0) / (n - 1)) : NAN;
    }
}

static status measure(const paper_options *o, const char *weights, paper_table *out)
{
    model_config config;
    eval_report report;
    const eval_options options = {.data = o->data,
                                  .weights = weights,
                                  .count = o->samples,
                                  .raw = true,
                                  .views = 1,
                                  .quiet = o->quiet,
                                  .stopped = o->stopped};
    status s = model_load_config(weights, &config);
    if (s == OK && !paper_figures_of(o->which, config.name, NULL))
        s = fail(MERLIN_BAD_INPUT, "%s: model \"%s\" is none of table1-1 to table1-9", weights, config.name);
    if (s == OK && config.lighting != MODEL_LIGHT_POINT)
        s = fail(MERLIN_BAD_INPUT, "%s: model \"%s\" is not for flash photographs, as those of the table are", weights,
                 config.name);
    if (s == OK) s = eval_run(&options, &report);
    if (s != OK) return s;
    paper_row *row = row_of(out, config.name);
    add_run(row, &report.all);
    out->samples = report.all.samples;
    out->size = report.size;
    return row->runs == 1 ? count_cost(weights, row) : OK;
}

status paper_table_run(const paper_options *o, paper_table *out)
{
    const double began = clock_seconds();
    *out = (paper_table){.which = o->which, .row = calloc((size_t)o->count + 1, sizeof *out->row)};
    if (!out->row) return fail(MERLIN_NO_MEMORY, "no memory for a table");
    status s = OK;
    for (int i = 0; s == OK && i < o->count; i++)
        s = measure(o, o->weights[i], out);
    for (int i = 0; i < out->rows; i++)
        finish(&out->row[i]);
    out->seconds = clock_seconds() - began;
    if (s != OK) paper_table_free(out);
    return s;
}

void paper_table_free(paper_table *t)
{
    free(t->row);
    *t = (paper_table){.rows = 0};
}
