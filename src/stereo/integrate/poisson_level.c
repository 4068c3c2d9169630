/* SPDX-License-Identifier: MIT */
#include "stereo/integrate/poisson_level.h"

#include "base/memory.h"

/* Returns the first node of a row or of the rows after it. */
static int first_from(const poisson_level *l, int row)
{
    int low = 0, high = l->count, width = poisson_width(l);
    while (low < high) {
        int middle = low + (high - low) / 2;
        if (poisson_place(l, middle) / width < row)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

status poisson_level_prepare(poisson_level *l)
{
    int width = poisson_width(l);
    l->odd = memory_new((size_t)l->count * sizeof *l->odd);
    if (!l->odd) return fail(MERLIN_NO_MEMORY, "no memory to integrate %d pixels", l->count);
#pragma omp parallel for schedule(static)
    for (int i = 0; i < l->count; i++)
        l->odd[i] = (poisson_place(l, i) % width + poisson_place(l, i) / width) & 1;
    for (int k = 0; k <= POISSON_STRIPS; k++)
        l->strip[k] = first_from(l, (poisson_height(l) + 1) / 2 * k / POISSON_STRIPS * 2);
    return OK;
}

void poisson_level_free(poisson_level *l)
{
    poisson_graph_free(&l->graph);
    memory_free(l->parent);
    memory_free(l->odd);
    memory_free(l->x);
    memory_free(l->b);
    *l = (poisson_level){0};
}
