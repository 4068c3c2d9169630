/* SPDX-License-Identifier: MIT */
/* Pages of maps (merlin/view.h) as commands write them. */
#ifndef MERLIN_CLI_PAGE_H
#define MERLIN_CLI_PAGE_H

#include "base/status.h"
#include "base/warnings.h"
#include "merlin/view.h"

/* What a page is called that nobody has named. */
#define PAGE_FILE "viewer.html"

/* A page's maps: of which photograph or folder they are, for its name, and where they lie. */
typedef struct page_source {
    const char *input, *folder;
    int side; /* as of merlin_view_params */
} page_source;

status page_write(const merlin_maps *maps, const page_source *of, const char *path);

/* Seconds that this costs for maps of so many pixels, beside what expect.h has. */
double page_cost(double pixels);

/* Adds a word where the square around the object, of so many pixels a side, has more than the page. */
void page_doubt(int square, int side, warnings *doubts);

#endif
