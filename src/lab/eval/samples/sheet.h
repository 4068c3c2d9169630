/* SPDX-License-Identifier: MIT */
/* A picture of predictions beside the truth, a row a sample (sheet_rows.h). */
#ifndef MERLIN_LAB_EVAL_SAMPLES_SHEET_H
#define MERLIN_LAB_EVAL_SAMPLES_SHEET_H

#include "estimate/surface/surface.h"
#include "lab/eval/samples/sheet_rows.h"

/* Columns of a row; between these the maps. */
enum {
    EVAL_SHEET_INPUT,
    EVAL_SHEET_MAPS,
    EVAL_SHEET_RECONSTRUCTION = 9,
    EVAL_SHEET_RELIT_TRUE,
    EVAL_SHEET_BY_NETWORK,
    EVAL_SHEET_BY_BRDF,
    EVAL_SHEET_COLUMNS
};

status eval_sheet_new(int rows, sheet_rows **out);
/* Fills the maps' columns of a row, true and found ones in turn. */
status eval_sheet_maps(const surface *truth, const surface *found, const img *mask, img *row);

#endif
