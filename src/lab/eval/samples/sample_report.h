/* SPDX-License-Identifier: MIT */
/* An evaluation as a table for a person and as JSON for a program. */
#ifndef MERLIN_LAB_EVAL_SAMPLES_SAMPLE_REPORT_H
#define MERLIN_LAB_EVAL_SAMPLES_SAMPLE_REPORT_H

#include <stdio.h>

#include "lab/eval/samples/evaluate.h"

/* Goal of a row: an error's ratio to the better trivial baseline, a similarity, or a similarity's margin over the
 * better trivial baseline. */
typedef enum eval_goal_kind { EVAL_NO_GOAL, EVAL_RATIO_AT_MOST, EVAL_AT_LEAST, EVAL_MARGIN_AT_LEAST } eval_goal_kind;

typedef struct eval_verdict {
    eval_goal_kind kind;
    double goal;
    double ratio;  /* model / better trivial baseline; NAN for similarities, and with a baseline without error */
    double margin; /* model - better trivial baseline; NAN for errors */
    bool holds;    /* false if there is no figure */
} eval_verdict;

/* Compares the scores with the goals of docs/evaluation.md; docs/notes/not_reached.md discusses those that are not
 * reached. */
eval_verdict eval_check_goal(const eval_scores *scores, eval_row row);

/* Returns EVAL_GIVEN_* for "albedo", "normal", "roughness" or "depth"; 0 for anything else. */
int eval_given_of(const char *name);

void eval_print_table(const eval_report *report, FILE *stream);
/* malloc'ed; NULL if memory ran out. */
char *eval_report_json(const eval_report *report);

#endif
