/* SPDX-License-Identifier: MIT */
/* The paper's Tables 1 and 2 as this project's networks have them: each weights file measured alone on held-out
 * samples (evaluate.h, raw), in the row of its model.
 *
 *     paper_options options = {.which = PAPER_TABLE2, .data = "heldout", .weights = files, .count = 3};
 *     paper_table table;
 *     status s = paper_table_run(&options, &table);
 *     if (s == OK) paper_table_print(&table, stdout);
 *     paper_table_free(&table);
 */
#ifndef MERLIN_LAB_EVAL_PAPER_PAPER_TABLE_H
#define MERLIN_LAB_EVAL_PAPER_PAPER_TABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "base/status.h"
#include "lab/eval/paper/paper_figures.h"

/* Figures of the runs of one model, which differ in their seeds. */
typedef struct paper_row {
    char model[64];
    int runs;
    double mean[PAPER_COLUMNS], spread[PAPER_COLUMNS]; /* spread: standard deviation of the runs, NAN of one; NAN: the
                                                        * model has no such column */
    double parameters, multiply_adds;                  /* the latter for a picture of 256×256 */
} paper_row;

typedef struct paper_table {
    paper_which which;
    size_t samples;
    int size; /* of the samples, pixels a side */
    paper_row *row;
    int rows;
    double seconds;
} paper_table;

typedef struct paper_options {
    paper_which which;
    const char *data;
    const char *const *weights; /* files */
    int count;
    size_t samples; /* the first so many; 0: all */
    bool quiet;
    int (*stopped)(void);
} paper_options;

/* MERLIN_BAD_INPUT if a model has no row there, and what eval_run returns. */
status paper_table_run(const paper_options *options, paper_table *out);
void paper_table_free(paper_table *t);
void paper_table_print(const paper_table *t, FILE *stream);
/* Returns malloc'ed JSON; NULL if memory ran out. */
char *paper_table_json(const paper_table *t);

#endif
