/* SPDX-License-Identifier: MIT */
/* A picture of predictions beside the truth, a row a sample. */
#ifndef MERLIN_LAB_EVAL_SHEET_H
#define MERLIN_LAB_EVAL_SHEET_H

#include "lab/eval/predict.h"
#include "lab/eval/sheet_rows.h"

/* For at most `rows` samples; later ones are ignored. */
status eval_sheet_new(int rows, sheet_rows **out);
/* relit_true: the target under the prediction's first light. Everything is copied. */
status eval_sheet_add(sheet_rows *sheet, const img *image, const img *mask, const eval_maps *truth,
                      const eval_prediction *p, const img *relit_true);

#endif
