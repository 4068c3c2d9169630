/* SPDX-License-Identifier: MIT */
/* paper_table.h's table as text and as JSON. */
#include <cjson/cJSON.h>
#include <math.h>
#include <string.h>

#include "base/json/json_put.h"
#include "base/text/report.h"
#include "lab/eval/paper/paper_table.h"

typedef struct column_words {
    const char *heading, *key;
    double factor; /* of the printed figure */
    int decimals;
} column_words;

static const column_words words[PAPER_COLUMNS] = {
    [PAPER_ALBEDO] = {"A", "albedo", 100, 3},
    [PAPER_ROUGHNESS] = {"R", "roughness", 100, 3},
    [PAPER_NORMAL] = {"N", "normal", 100, 3},
    [PAPER_DEPTH] = {"D", "depth", 100, 3},
    [PAPER_NETWORK] = {"by network", "relight_network_ssim", 1, 3},
    [PAPER_BRDF] = {"by BRDF", "relight_brdf_ssim", 1, 3},
};

enum { LABEL = 25, CELL = 16 };

static void print_cell(FILE *stream, const column_words *w, double value, double spread)
{
    char text[48];
    if (isnan(value))
        snprintf(text, sizeof text, "-");
    else if (isnan(spread))
        snprintf(text, sizeof text, "%.*f", w->decimals, w->factor * value);
    else
        snprintf(text, sizeof text, "%.*f +-%.*f", w->decimals, w->factor * value, w->decimals, w->factor * spread);
    fprintf(stream, "%*s", CELL, text);
}

static void print_row(const paper_table *t, const paper_row *row, FILE *stream)
{
    const char *label;
    const double *figures = paper_figures_of(t->which, row->model, &label);
    fprintf(stream, "%-*s", LABEL, label);
    for (int i = 0; i < PAPER_COLUMNS; i++)
        print_cell(stream, &words[i], row->mean[i], row->spread[i]);
    fprintf(stream, "%10.2f%8.1f", row->parameters / 1e6, row->multiply_adds / 1e9);
    if (row->runs > 1) fprintf(stream, "   %d runs", row->runs);
    fprintf(stream, "\n%-*s", LABEL, "   in the paper");
    for (int i = 0; i < PAPER_COLUMNS; i++)
        print_cell(stream, &words[i], figures[i] / words[i].factor, NAN);
    fputc('\n', stream);
}

void paper_table_print(const paper_table *t, FILE *stream)
{
    fprintf(stream,
            "Table %d on %zu samples of %dx%d: mean squared errors in 1e-2, SSIM of relit images, millions of "
            "parameters, GMAC\nat 256x256; the paper's figures are of the data of Li et al. 2018\n\n%-*s",
            t->which == PAPER_TABLE1 ? 1 : 2, t->samples, t->size, t->size, LABEL, "");
    for (int i = 0; i < PAPER_COLUMNS; i++)
        fprintf(stream, "%*s", CELL, words[i].heading);
    fprintf(stream, "%10s%8s\n", "params", "GMAC");
    for (int i = 0; i < t->rows; i++)
        print_row(t, &t->row[i], stream);
    fprintf(stream, "\n%.1f s\n", t->seconds);
}

char *paper_table_json(const paper_table *t)
{
    cJSON *root = report_begin(&(warnings){0});
    json_put_number(root, "table", t->which == PAPER_TABLE1 ? 1 : 2);
    json_put_number(root, "samples", (double)t->samples);
    json_put_number(root, "size", t->size);
    json_put_number(root, "seconds", t->seconds);
    cJSON *rows = json_put_object(root, "models");
    for (int i = 0; i < t->rows; i++) {
        const paper_row *row = &t->row[i];
        cJSON *o = json_put_object(rows, row->model);
        json_put_number(o, "runs", row->runs);
        json_put_number(o, "parameters", row->parameters);
        json_put_number(o, "multiply_adds_at_256", row->multiply_adds);
        for (int k = 0; k < PAPER_COLUMNS; k++) {
            cJSON *column = isnan(row->mean[k]) ? NULL : json_put_object(o, words[k].key);
            if (!column) continue;
            json_put_number(column, "mean", row->mean[k]);
            if (!isnan(row->spread[k])) json_put_number(column, "standard_deviation", row->spread[k]);
        }
    }
    char *text = json_print_line(root);
    cJSON_Delete(root);
    return text;
}
