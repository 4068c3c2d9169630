/* SPDX-License-Identifier: MIT */
/* A photograph, its maps and two new lights as tiles for a sheet, at the network's size.
 *
 *     overview o;
 *     status s = overview_new(model->network, &maps, &o);
 *     figure_tile tiles[OVERVIEW_TILES];
 *     overview_tiles(&o, tiles);
 *     ... figure_sheet(path, tiles, OVERVIEW_TILES, 4, 256) ...
 *     overview_free(&o);
 */
#ifndef MERLIN_ESTIMATE_FILES_OVERVIEW_H
#define MERLIN_ESTIMATE_FILES_OVERVIEW_H

#include "estimate/relight/relighter.h"
#include "image/write/figure.h"

/* Number of tiles; the photograph is the first. */
enum { OVERVIEW_TILES = 8 };

typedef struct overview {
    relighter relighter;
    img normal, roughness, depth, reconstruction, left, right;
} overview;

/* Makes the overview of maps from merlin_estimate. */
status overview_new(network *n, const merlin_maps *maps, overview *out);
void overview_free(overview *o);
/* Lists the tiles, whose pictures are borrowed from o. */
void overview_tiles(const overview *o, figure_tile tiles[OVERVIEW_TILES]);

#endif
