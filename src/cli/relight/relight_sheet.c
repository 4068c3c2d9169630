/* SPDX-License-Identifier: MIT */
#include "cli/relight/relight_sheet.h"

#include <math.h>
#include <stdio.h>

enum { TILE_SIZE = 192, COLUMNS = 6 };

void relight_sheet_free(relight_sheet *s)
{
    for (int i = 0; i < s->count; i++)
        merlin_image_free(&s->pictures[i]);
}

/* Rounds to hundredths, without "-0.00". */
static double shown(float x)
{
    return round(100 * (double)x) / 100 + 0.0;
}

void relight_label(const merlin_lamp *lights, int count, char label[RELIGHT_LABEL])
{
    if (count)
        snprintf(label, RELIGHT_LABEL, "%s%.2f, %.2f, %.2f", lights->distant ? "toward " : "", shown(lights->at[0]),
                 shown(lights->at[1]), shown(lights->at[2]));
    else
        snprintf(label, RELIGHT_LABEL, "environment");
}

status relight_sheet_write(const relight_sheet *s, const char *path)
{
    merlin_tile tiles[RELIGHT_MOST_TILES];
    for (int i = 0; i < s->count; i++)
        tiles[i] = (merlin_tile){s->labels[i], &s->pictures[i]};
    int columns = s->count < COLUMNS ? s->count : COLUMNS;
    return merlin_sheet_write(tiles, s->count, columns, TILE_SIZE, path);
}

status relight_sheet_add(relight_sheet *s, const merlin_image *picture, const char *label)
{
    if (s->count == RELIGHT_MOST_TILES) return OK;
    status result = merlin_image_resize(picture, TILE_SIZE, TILE_SIZE, &s->pictures[s->count]);
    if (result == OK) snprintf(s->labels[s->count++], RELIGHT_LABEL, "%s", label);
    return result;
}
