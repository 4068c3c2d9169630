/* SPDX-License-Identifier: MIT */
#include "cli/page.h"

#include <stdlib.h>
#include <string.h>

#include "base/file.h"

/* Returns the name of a photograph or folder without its ending: "cup" for photos/cup.jpg and photos/cup.merlin;
 * malloc'ed. */
static char *name_of(const char *path)
{
    char *whole = realpath(path, NULL); /* also for "." and "cup/"; NULL for standard input */
    char *name = strdup(file_name_of(whole ? whole : path));
    free(whole);
    char *ending = name ? strrchr(name, '.') : NULL;
    if (ending && ending != name) *ending = 0;
    return name;
}

status page_write(const merlin_maps *maps, const page_source *of, const char *path)
{
    char *name = name_of(of->input);
    if (!name) return fail(MERLIN_NO_MEMORY, "no memory for a file name");
    const merlin_view_params params = {.name = name, .folder = of->folder, .side = of->side};
    status s = merlin_view_write(maps, &params, path);
    free(name);
    return s;
}

double page_cost(double pixels)
{
    return 0.2 + 0.3 * pixels / 1e6;
}

void page_doubt(int square, int side, warnings *doubts)
{
    const int most = side ? side : MERLIN_VIEW_SIDE;
    char remedy[64] = "";
    if (!side) snprintf(remedy, sizeof remedy, ": view --size takes up to %d", MERLIN_VIEW_MOST_SIDE);
    if (square > most)
        warnings_add(doubts, "page_reduced", "the page has %d of the object's %d pixels a side%s", most, square,
                     remedy);
}
