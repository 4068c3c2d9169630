/* SPDX-License-Identifier: MIT */
/* An evaluation as a table for a person and as JSON for a program. */
#ifndef MERLIN_LAB_EVAL_SAMPLES_SAMPLE_REPORT_H
#define MERLIN_LAB_EVAL_SAMPLES_SAMPLE_REPORT_H

#include <stdio.h>

#include "lab/eval/samples/evaluate.h"

/* What a row is asked to reach: an error's ratio to the better trivial answer, a similarity, or a similarity's margin
 * over the better trivial answer. */
typedef enum eval_goal_kind { EVAL_NO_GOAL, EVAL_RATIO_AT_MOST, EVAL_AT_LEAST, EVAL_MARGIN_AT_LEAST } eval_goal_kind;

typedef struct eval_verdict {
    eval_goal_kind kind;
    double goal;
    double ratio;  /* model / better trivial answer; NAN for similarities, and beside an answer without error */
    double margin; /* model - better trivial answer; NAN for errors */
    bool holds;    /* false where there is no figure */
} eval_verdict;

/* The goals of docs/evaluation.md held against the scores; what is short is in docs/notes/not_reached.md. */
eval_verdict eval_judge(const eval_scores *scores, eval_row row);

/* EVAL_GIVEN_* of "albedo", "normal", "roughness" or "depth"; 0 for anything else. */
int eval_given_of(const char *name);

void eval_print_table(const eval_report *report, FILE *stream);
/* malloc'ed; NULL if memory ran out. */
char *eval_report_json(const eval_report *report);

#endif
