/* SPDX-License-Identifier: MIT */
/* A picture of what photometric stereo found: a line of tiles an object, its photograph, true and found normals, and
 * where the found ones are off. Internal to the evaluation of stereo.
 *
 *     sheet_rows *sheet;
 *     status s = stereo_sheet_new(14, &sheet);
 *     if (s == OK) s = stereo_sheet_add(sheet, &object, normals);      again for each object
 *     if (s == OK) s = sheet_rows_write(sheet, "sheet.png");
 *     sheet_rows_free(sheet);
 */
#ifndef MERLIN_LAB_EVAL_STEREO_STEREO_SHEET_H
#define MERLIN_LAB_EVAL_STEREO_STEREO_SHEET_H

#include "lab/eval/samples/sheet_rows.h"
#include "lab/eval/stereo/stereo_object.h"
#include "lab/eval/stereo/stereo_row.h"

status stereo_sheet_new(size_t objects, sheet_rows **out);
/* normal: one a row of the table, of the capture's size; empty where there is no solution. */
status stereo_sheet_add(sheet_rows *sheet, const stereo_object *o, const img normal[STEREO_ROWS]);

#endif
