/* SPDX-License-Identifier: MIT */
/* One sample's figures, for evaluate.c: what the model and the trivial answers reach on it. */
#ifndef MERLIN_LAB_EVAL_SCORE_H
#define MERLIN_LAB_EVAL_SCORE_H

#include "lab/eval/score_parts.h"

/* All rows that the sample and the model have. */
status eval_score_sample(eval_scorer *e, const sample *s, eval_scores *scores);

#endif
