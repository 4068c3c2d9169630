/* SPDX-License-Identifier: MIT */
/* merlin/view: maps as a page that a browser opens from the disk, and in which they are lit.
 *
 *     merlin_maps maps;
 *     const merlin_view_params params = {.name = "cup"};
 *     if (merlin_maps_read("cup.merlin", &maps) || merlin_view_write(&maps, &params, "cup.html"))
 *         fprintf(stderr, "%s\n", merlin_error());
 *
 * One file that asks the network for nothing: the maps of the square around the object, as compressed whole numbers,
 * and the program that lights them (WebGL2) as merlin_relight does it, MERLIN_BY_BRDF_DIRECT. A captured surface is
 * exposed so that lamps of power 1 at distance 1 leave it below white. */
#ifndef MERLIN_VIEW_H
#define MERLIN_VIEW_H

#include <merlin/maps.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Larger squares are brought to so many pixels a side. */
enum { MERLIN_VIEW_SIDE = 2048, MERLIN_VIEW_LEAST_SIDE = 64, MERLIN_VIEW_MOST_SIDE = 4096 };

/* All zeros is the usual case. */
typedef struct merlin_view_params {
    const char *name;   /* what the page is called; NULL: "object" */
    const char *folder; /* of the maps, for the commands that the page tells; NULL: "FOLDER" */
    int side;           /* another than MERLIN_VIEW_SIDE, within the other two; 0: that */
} merlin_view_params;

/* The whole page or, after a failure, none. params NULL: the usual case. */
merlin_status merlin_view_write(const merlin_maps *maps, const merlin_view_params *params, const char *path);

#ifdef __cplusplus
}
#endif

#endif
