/* SPDX-License-Identifier: MIT */
/* A picture of what photometric stereo found: a line of tiles an object, its photograph, true and found normals, and
 * where the found ones are off. Internal to the evaluation of stereo.
 *
 *     stereo_sheet sheet;
 *     status s = stereo_sheet_new(14, asked, &sheet);
 *     if (s == OK) s = stereo_sheet_add(&sheet, &object, normals);      again for each object
 *     if (s == OK) s = sheet_rows_write(sheet.rows, "sheet.png");
 *     stereo_sheet_free(&sheet);
 */
#ifndef MERLIN_LAB_EVAL_STEREO_STEREO_SHEET_H
#define MERLIN_LAB_EVAL_STEREO_STEREO_SHEET_H

#include "lab/eval/samples/sheet_rows.h"
#include "lab/eval/stereo/stereo_object.h"
#include "lab/eval/stereo/stereo_row.h"

enum { STEREO_SHEET_COLUMNS = 2 + 2 * STEREO_ROWS };

/* Must stay where it is while its rows are used, which refer to its labels. */
typedef struct stereo_sheet {
    sheet_rows *rows;
    bool asked[STEREO_ROWS];
    const char *labels[STEREO_SHEET_COLUMNS];
} stereo_sheet;

/* asked: whether the table has each row; the others get no columns. */
status stereo_sheet_new(size_t objects, const bool asked[STEREO_ROWS], stereo_sheet *out);
void stereo_sheet_free(stereo_sheet *sheet);
/* normal: one a row of the table, of the capture's size; empty where there is no solution. */
status stereo_sheet_add(stereo_sheet *sheet, const stereo_object *o, const img normal[STEREO_ROWS]);

#endif
