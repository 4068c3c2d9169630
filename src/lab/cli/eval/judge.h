/* SPDX-License-Identifier: MIT */
/* Weights of the network that judges pictures of unknown lights, for commands with --method universal. */
#ifndef MERLIN_LAB_CLI_EVAL_JUDGE_H
#define MERLIN_LAB_CLI_EVAL_JUDGE_H

#include "lab/eval/stereo/stereo_table.h"

typedef struct judge {
    char *weights, *several;
} judge;

/* Checks the method that the user named, NULL for none; MERLIN_WRONG_USE for another than "universal". */
status judge_check(const char *method);
/* Finds the weights, if a method is named, and puts them into options, which borrow them. */
status judge_find(const char *method, judge *out, stereo_options *options);
void judge_free(judge *j);

#endif
