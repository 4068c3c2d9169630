#include "eval/sheet.h"

#include <stdlib.h>

#include "image/figure.h"

enum { COLUMNS = 13, TILE = 128 };

static const char *const labels[COLUMNS] = {
    "input",           "albedo, true", "albedo",         "normal, true", "normal",           "depth, true",  "depth",
    "roughness, true", "roughness",    "reconstruction", "relit, true",  "relit by network", "relit by BRDF"};

struct eval_sheet {
    int rows, used;
    img *images; /* rows × COLUMNS */
};

status eval_sheet_new(int rows, eval_sheet **out)
{
    *out = NULL;
    eval_sheet *sheet = malloc(sizeof *sheet);
    if (sheet) *sheet = (eval_sheet){rows, 0, calloc((size_t)rows * COLUMNS, sizeof(img))};
    if (!sheet || !sheet->images) {
        free(sheet);
        return fail(ERROR_MEMORY, "no memory for a sheet of %d rows", rows);
    }
    *out = sheet;
    return OK;
}

void eval_sheet_free(eval_sheet *sheet)
{
    if (!sheet) return;
    for (int i = 0; i < sheet->rows * COLUMNS; i++)
        img_free(&sheet->images[i]);
    free(sheet->images);
    free(sheet);
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

status eval_sheet_add(eval_sheet *sheet, const img *image, const img *mask, const eval_maps *truth,
                      const eval_prediction *p, const img *relit_true)
{
    if (sheet->used == sheet->rows) return OK;
    img *row = sheet->images + sheet->used * COLUMNS;
    status s = img_copy(&row[0], image);
    if (s == OK) s = show_maps(truth, mask, row, 1);
    if (s == OK) s = show_maps(&p->maps, mask, row, 2);
    if (s == OK) s = img_copy(&row[9], &p->reconstruction);
    if (s == OK) s = img_copy(&row[10], relit_true);
    if (s == OK) s = img_copy(&row[11], &p->by_network[0]);
    if (s == OK) s = img_copy(&row[12], &p->by_brdf[0]);
    if (s == OK) sheet->used++;
    return s;
}

status eval_sheet_write(const eval_sheet *sheet, const char *path)
{
    int count = sheet->used * COLUMNS;
    figure_tile *tiles = malloc((size_t)(count ? count : 1) * sizeof *tiles);
    if (!tiles) return fail(ERROR_MEMORY, "no memory for a sheet of %d rows", sheet->used);
    for (int i = 0; i < count; i++)
        tiles[i] = (figure_tile){labels[i % COLUMNS], &sheet->images[i]};
    status s = figure_sheet(path, tiles, count, COLUMNS, TILE);
    free(tiles);
    return s;
}
