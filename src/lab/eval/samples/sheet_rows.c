/* SPDX-License-Identifier: MIT */
#include "lab/eval/samples/sheet_rows.h"

#include <stdlib.h>

#include "image/write/figure.h"

enum { TILE = 128 };

struct sheet_rows {
    size_t rows, columns, used;
    const char *const *labels;
    img images[];
};

status sheet_rows_new(size_t rows, size_t columns, const char *const *labels, sheet_rows **out)
{
    sheet_rows *sheet = calloc(1, sizeof *sheet + rows * columns * sizeof(img));
    *out = sheet;
    if (!sheet) return fail(MERLIN_NO_MEMORY, "no memory for a sheet of %zu rows", rows);
    sheet->rows = rows;
    sheet->columns = columns;
    sheet->labels = labels;
    return OK;
}

void sheet_rows_free(sheet_rows *sheet)
{
    if (!sheet) return;
    for (size_t i = 0; i < sheet->rows * sheet->columns; i++)
        img_free(&sheet->images[i]);
    free(sheet);
}

img *sheet_rows_begin(sheet_rows *sheet)
{
    if (sheet->used == sheet->rows) return NULL;
    img *row = sheet->images + sheet->used * sheet->columns;
    for (size_t i = 0; i < sheet->columns; i++)
        img_free(&row[i]); /* of one that was not kept */
    return row;
}

void sheet_rows_keep(sheet_rows *sheet)
{
    sheet->used++;
}

status sheet_rows_write(const sheet_rows *sheet, const char *path)
{
    size_t count = sheet->used * sheet->columns;
    figure_tile *tiles = malloc((count ? count : 1) * sizeof *tiles);
    if (!tiles) return fail(MERLIN_NO_MEMORY, "no memory for a sheet of %zu rows", sheet->used);
    for (size_t i = 0; i < count; i++)
        tiles[i] = (figure_tile){sheet->labels[i % sheet->columns], &sheet->images[i]};
    status s = figure_sheet(path, tiles, (int)count, (int)sheet->columns, TILE);
    free(tiles);
    return s;
}
