/* SPDX-License-Identifier: MIT */
/* The paper's Table 3 with several relighters: normals of one picture, of pictures relit by each, and of real ones, by
 * each judge (stereo_table.h). Relit as the paper does: by the maps' BRDF, and by its network where it is Sang's.
 *
 *     paper3_options options = {.stereo = {.data = "near-field"}, .weights = files, .count = 3};
 *     paper3_table table;
 *     status s = paper3_table_run(&options, &table);
 *     if (s == OK) paper3_table_print(&table, stdout);
 *     paper3_table_free(&table);
 */
#ifndef MERLIN_LAB_EVAL_PAPER_PAPER_TABLE3_H
#define MERLIN_LAB_EVAL_PAPER_PAPER_TABLE3_H

#include "lab/eval/stereo/stereo_table.h"

typedef struct paper3_options {
    stereo_options stereo; /* without weights */
    const char *const *weights;
    int count;
} paper3_options;

typedef struct paper3_table {
    stereo_table *of; /* by weights; only the first has the rows of real pictures */
    int count;
} paper3_table;

status paper3_table_run(const paper3_options *options, paper3_table *out);
void paper3_table_free(paper3_table *t);
void paper3_table_print(const paper3_table *t, FILE *stream);
/* Returns malloc'ed JSON; NULL if memory ran out. */
char *paper3_table_json(const paper3_table *t);

#endif
