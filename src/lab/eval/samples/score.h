/* SPDX-License-Identifier: MIT */
/* Scores one sample, for evaluate.c: by the model and by the trivial answers. */
#ifndef MERLIN_LAB_EVAL_SAMPLES_SCORE_H
#define MERLIN_LAB_EVAL_SAMPLES_SCORE_H

#include "lab/eval/samples/score_parts.h"

/* Fills all rows that the sample and the model have. */
status eval_score_sample(eval_scorer *e, const sample *s, eval_scores *scores);

#endif
