/* SPDX-License-Identifier: MIT */
#include "lab/eval/sheet.h"

#include "image/write/figure.h"

enum { COLUMNS = 13 };

static const char *const labels[COLUMNS] = {
    "input",           "albedo, true", "albedo",         "normal, true", "normal",           "depth, true",  "depth",
    "roughness, true", "roughness",    "reconstruction", "relit, true",  "relit by network", "relit by BRDF"};

status eval_sheet_new(int rows, sheet_rows **out)
{
    return sheet_rows_new((size_t)rows, COLUMNS, labels, out);
}

/* From [-1, 1] to [0, 1], black outside the mask. */
static status show_unit(const img *map, const img *mask, img *out)
{
    status s = img_copy(out, map);
    if (s != OK) return s;
    size_t channels = (size_t)map->channels;
    for (size_t i = 0, n = (size_t)map->width * (size_t)map->height * channels; i < n; i++)
        out->data[i] = mask->data[i / channels] > 0 ? (out->data[i] + 1) / 2 : 0;
    return OK;
}

static status show_maps(const eval_maps *maps, const img *mask, img *row, int first)
{
    status s = show_unit(&maps->albedo, mask, &row[first]);
    if (s == OK) s = figure_normals(&maps->normal, mask, &row[first + 2]);
    if (s == OK) s = figure_depth(&maps->depth, mask, &row[first + 4]);
    if (s == OK) s = show_unit(&maps->roughness, mask, &row[first + 6]);
    return s;
}

status eval_sheet_add(sheet_rows *sheet, const img *image, const img *mask, const eval_maps *truth,
                      const eval_prediction *p, const img *relit_true)
{
    img *row = sheet_rows_begin(sheet);
    if (!row) return OK;
    status s = img_copy(&row[0], image);
    if (s == OK) s = show_maps(truth, mask, row, 1);
    if (s == OK) s = show_maps(&p->maps, mask, row, 2);
    if (s == OK) s = img_copy(&row[9], &p->reconstruction);
    if (s == OK) s = img_copy(&row[10], relit_true);
    if (s == OK) s = img_copy(&row[11], &p->by_network[0]);
    if (s == OK) s = img_copy(&row[12], &p->by_brdf[0]);
    if (s == OK) sheet_rows_keep(sheet);
    return s;
}
