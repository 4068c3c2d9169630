/* SPDX-License-Identifier: MIT */
#include "nn/plan.h"

#include <stdint.h>
#include <stdlib.h>

static int by_size(const void *a, const void *b)
{
    const plan_buffer *x = *(plan_buffer *const *)a, *y = *(plan_buffer *const *)b;
    if (x->bytes != y->bytes) return x->bytes < y->bytes ? 1 : -1;
    return x < y ? -1 : x > y; /* array order, so that a plan is reproducible */
}

static int by_offset(const void *a, const void *b)
{
    const plan_buffer *x = *(plan_buffer *const *)a, *y = *(plan_buffer *const *)b;
    if (x->offset != y->offset) return x->offset < y->offset ? -1 : 1;
    return x < y ? -1 : x > y;
}

static size_t aligned(size_t bytes)
{
    return (bytes + PLAN_ALIGNMENT - 1) / PLAN_ALIGNMENT * PLAN_ALIGNMENT;
}

/* Returns the smallest gap between buffers (sorted by offset) that holds b, else the offset behind all of them. */
static size_t best_offset(const plan_buffer *b, plan_buffer *const *placed, size_t count)
{
    size_t end = 0, best = SIZE_MAX, best_gap = SIZE_MAX;
    for (size_t i = 0; i < count; i++) {
        size_t gap = placed[i]->offset > end ? placed[i]->offset - end : 0;
        if (gap >= b->bytes && gap < best_gap) {
            best = end;
            best_gap = gap;
        }
        size_t behind = aligned(placed[i]->offset + placed[i]->bytes);
        if (behind > end) end = behind;
    }
    return best != SIZE_MAX ? best : end;
}

status plan_memory(plan_buffer *buffers, size_t count, size_t *size)
{
    *size = 0;
    plan_buffer **order = malloc((2 * count + 1) * sizeof *order);
    if (!order) return fail(MERLIN_NO_MEMORY, "no memory to plan %zu buffers", count);
    plan_buffer **together = order + count;
    for (size_t i = 0; i < count; i++)
        order[i] = &buffers[i];
    qsort(order, count, sizeof *order, by_size);
    for (size_t i = 0; i < count; i++) {
        size_t n = 0;
        for (size_t k = 0; k < i; k++)
            if (order[k]->first <= order[i]->last && order[i]->first <= order[k]->last) together[n++] = order[k];
        qsort(together, n, sizeof *together, by_offset);
        order[i]->offset = best_offset(order[i], together, n);
        size_t end = aligned(order[i]->offset + order[i]->bytes);
        if (end > *size) *size = end;
    }
    free(order);
    return OK;
}
