/* SPDX-License-Identifier: MIT */
/* Pages of maps (merlin/view.h) as commands write them. */
#ifndef MERLIN_CLI_PAGE_H
#define MERLIN_CLI_PAGE_H

#include "base/status.h"
#include "base/warnings.h"
#include "merlin/view.h"

/* Default name of a page. */
#define PAGE_FILE "viewer.html"

/* Source of a page's maps: the photograph or folder, for its title, and the path of the maps. */
typedef struct page_source {
    const char *input, *folder;
    int side; /* as in merlin_view_params */
} page_source;

status page_write(const merlin_maps *maps, const page_source *of, const char *path);

/* Returns the seconds for a page of maps of this size, in addition to those of expect.h. */
double page_cost(double pixels);

/* Adds a warning if the square around the object, of this many pixels a side, is larger than the page. */
void page_doubt(int square, int side, warnings *doubts);

#endif
