/* SPDX-License-Identifier: MIT */
/* Pictures for people: labelled contact sheets and line charts.
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

/* columns tiles a row, each tile tile_size pixels square, dark neutral background, labels under the tiles. */
status figure_sheet(const char *path, const figure_tile *tiles, int count, int columns, int tile_size);

typedef struct figure_curve {
    const char *label;
    const float *x, *y;
    int count;
} figure_curve;
/* Line chart with axes, ticks and a legend beside it, as PNG of 960 × 600 pixels and the legend's width; logarithmic y
 * if asked. NaN points are left out. */
status figure_chart(const char *path, const char *title, const char *x_label, const char *y_label, bool log_y,
                    const figure_curve *curves, int count);

/* Unit normals to displayable colours that img_write_png/figure_sheet show as (n + 1)/2 (pre-decoded from sRGB), black
 * outside the mask; depth to a readable grey or colour map between the mask's own extremes. */
status figure_normals(const img *normal, const img *mask, img *out);
status figure_depth(const img *depth, const img *mask, img *out);

#endif
