/* SPDX-License-Identifier: MIT */
/* Figures: labelled contact sheets and line charts.
 *
 *     figure_tile tiles[] = {{"input", &photo}, {"albedo", &albedo}, ...};
 *     status s = figure_sheet("overview.png", tiles, 8, 4, 256);
 */
#ifndef MERLIN_IMAGE_WRITE_FIGURE_H
#define MERLIN_IMAGE_WRITE_FIGURE_H

#include <stdbool.h>

#include "image/image.h"

typedef struct figure_tile {
    const char *label;
    const img *image; /* 1 or 3 channels, linear, shown as sRGB; resized to fit the tile */
} figure_tile;

/* Draws `columns` tiles a row, each tile_size pixels square, on a dark neutral background with labels below. */
status figure_sheet(const char *path, const figure_tile *tiles, int count, int columns, int tile_size);

typedef struct figure_curve {
    const char *label;
    const float *x, *y;
    int count;
} figure_curve;
/* Draws a line chart with axes, ticks and a legend beside it, as PNG of 960 × 600 pixels and the legend's width; with a
 * logarithmic y axis if log_y. NaN points are left out. */
status figure_chart(const char *path, const char *title, const char *x_label, const char *y_label, bool log_y,
                    const figure_curve *curves, int count);

/* Convert maps to displayable colours for img_write_png and figure_sheet: unit normals as (n + 1)/2 (decoded from sRGB,
 * as they will be encoded), black outside the mask; depth as grey between its extremes inside the mask. */
status figure_normals(const img *normal, const img *mask, img *out);
status figure_depth(const img *depth, const img *mask, img *out);

#endif
