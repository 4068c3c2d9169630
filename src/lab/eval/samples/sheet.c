/* SPDX-License-Identifier: MIT */
#include "lab/eval/samples/sheet.h"

#include "image/write/figure.h"
#include "lab/eval/samples/truth.h"

static const char *const labels[EVAL_SHEET_COLUMNS] = {
    "input",           "albedo, true", "albedo",         "normal, true", "normal",           "depth, true",  "depth",
    "roughness, true", "roughness",    "reconstruction", "relit, true",  "relit by network", "relit by BRDF"};

status eval_sheet_new(int rows, sheet_rows **out)
{
    return sheet_rows_new((size_t)rows, EVAL_SHEET_COLUMNS, labels, out);
}

/* Fills every other column from this one on. */
static status show_maps(const surface *maps, const img *mask, img *column)
{
    status s = eval_picture(&maps->albedo, NULL, mask, &column[0]);
    if (s == OK) s = figure_normals(&maps->normal, mask, &column[2]);
    if (s == OK) s = figure_depth(&maps->depth, mask, &column[4]);
    return s == OK ? eval_picture(&maps->roughness, NULL, mask, &column[6]) : s;
}

status eval_sheet_maps(const surface *truth, const surface *found, const img *mask, img *row)
{
    status s = show_maps(truth, mask, row + EVAL_SHEET_MAPS);
    return s == OK ? show_maps(found, mask, row + EVAL_SHEET_MAPS + 1) : s;
}
