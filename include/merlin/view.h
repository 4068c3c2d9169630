/* SPDX-License-Identifier: MIT */
/* merlin/view: maps as a page that a browser opens from the disk, and in which they can be lit.
 *
 *     merlin_maps maps;
 *     const merlin_view_params params = {.name = "cup"};
 *     if (merlin_maps_read("cup.merlin", &maps) || merlin_view_write(&maps, &params, "cup.html"))
 *         fprintf(stderr, "%s\n", merlin_error());
 *
 * The page is one file that does not access the network: the maps of the square around the object, as compressed
 * integers, and the program that lights them (WebGL2) as merlin_relight does with MERLIN_BY_BRDF_DIRECT. A captured
 * surface is exposed so that lamps of power 1 at distance 1 leave it below white. */
#ifndef MERLIN_VIEW_H
#define MERLIN_VIEW_H

#include <merlin/maps.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Bounds of the page's pixels a side; larger squares are reduced to the first by default. */
enum { MERLIN_VIEW_SIDE = 2048, MERLIN_VIEW_LEAST_SIDE = 64, MERLIN_VIEW_MOST_SIDE = 4096 };

/* Options; all zeros are the defaults. */
typedef struct merlin_view_params {
    const char *name;   /* title of the page; NULL: "object" */
    const char *folder; /* path of the maps, for the commands that the page shows; NULL: "FOLDER" */
    int side;           /* another value than MERLIN_VIEW_SIDE, within the other two; 0: that */
} merlin_view_params;

/* Writes the page completely or, after a failure, not at all. path: ends in .html or .htm, else MERLIN_WRONG_USE;
 * params NULL: the defaults. */
merlin_status merlin_view_write(const merlin_maps *maps, const merlin_view_params *params, const char *path);

#ifdef __cplusplus
}
#endif

#endif
