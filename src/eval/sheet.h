/* A picture of predictions beside the truth, a row a sample. */
#ifndef MERLIN_EVAL_SHEET_H
#define MERLIN_EVAL_SHEET_H

#include "eval/predict.h"

typedef struct eval_sheet eval_sheet;

/* For at most `rows` samples; later ones are ignored. */
status eval_sheet_new(int rows, eval_sheet **out);
void eval_sheet_free(eval_sheet *sheet);
/* relit_true: the target under the prediction's first light. Everything is copied. */
status eval_sheet_add(eval_sheet *sheet, const img *image, const img *mask, const eval_maps *truth,
                      const eval_prediction *p, const img *relit_true);
status eval_sheet_write(const eval_sheet *sheet, const char *path);

#endif
