/* SPDX-License-Identifier: MIT */
/* A contact sheet that is filled row by row: what the evaluation's sheets share.
 *
 *     sheet_rows *sheet;
 *     status s = sheet_rows_new(10, 3, labels, &sheet);
 *     img *row = sheet_rows_begin(sheet);                NULL once it is full
 *     ... row[0] to row[2] become images, which it owns ...
 *     if (s == OK) sheet_rows_keep(sheet);               or the next row takes its place
 *     if (s == OK) s = sheet_rows_write(sheet, "sheet.png");
 *     sheet_rows_free(sheet); */
#ifndef MERLIN_LAB_EVAL_SAMPLES_SHEET_ROWS_H
#define MERLIN_LAB_EVAL_SAMPLES_SHEET_ROWS_H

#include <stddef.h>

#include "image/image.h"

typedef struct sheet_rows sheet_rows;

/* labels: one a column; they must outlive it. */
status sheet_rows_new(size_t rows, size_t columns, const char *const *labels, sheet_rows **out);
void sheet_rows_free(sheet_rows *sheet);
img *sheet_rows_begin(sheet_rows *sheet);
void sheet_rows_keep(sheet_rows *sheet);
status sheet_rows_write(const sheet_rows *sheet, const char *path);

#endif
