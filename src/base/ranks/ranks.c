/* SPDX-License-Identifier: MIT */
#include "base/ranks/ranks.h"

#include <stdbool.h>
#include <stdlib.h>

/* floats in a piece: large enough for the network's full rate, small beside a model */
enum { PIECE = 1 << 17 };

int ranks_count(const ranks *r)
{
    return r ? r->count : 1;
}

int ranks_index(const ranks *r)
{
    return r ? r->index : 0;
}

void ranks_close(ranks *r)
{
    if (r) r->close();
}

void ranks_abort(ranks *r)
{
    if (r) r->abort_all();
}

static bool is_alone(const ranks *r)
{
    return ranks_count(r) == 1;
}

status ranks_sum(const ranks *r, double *values, size_t count)
{
    if (is_alone(r)) return OK;
    double *all = malloc((size_t)r->count * count * sizeof *all);
    if (!all) return fail(MERLIN_NO_MEMORY, "no memory for %zu sums of %d ranks", count, r->count);
    r->all_gather(values, all, count * sizeof *values);
    for (size_t i = 0; i < count; i++) {
        values[i] = 0;
        for (size_t k = 0; k < (size_t)r->count; k++)
            values[i] += all[k * count + i];
    }
    free(all);
    return OK;
}

/* Sums the same piece of every rank's values, in double and in the ranks' order. */
static void add_up(const float *from, int count, size_t piece, float *sum)
{
    for (size_t i = 0; i < piece; i++) {
        double all = 0;
        for (int k = 0; k < count; k++)
            all += (double)from[(size_t)k * piece + i];
        sum[i] = (float)all;
    }
}

/* Sums `piece` values times the number of ranks; room must hold as many and one more piece. */
static void sum_round(const ranks *r, float *values, size_t piece, float *room)
{
    float *sum = room + (size_t)r->count * piece;
    r->all_to_all(values, room, piece * sizeof *values);
    add_up(room, r->count, piece, sum);
    r->all_gather(sum, values, piece * sizeof *values);
}

/* Sums what does not fill whole pieces: every rank adds up all of it. */
static void sum_rest(const ranks *r, float *values, size_t count, float *room)
{
    r->all_gather(values, room, count * sizeof *values);
    add_up(room, r->count, count, values);
}

status ranks_sum_floats(const ranks *r, float *values, size_t count)
{
    if (is_alone(r)) return OK;
    const size_t n = (size_t)r->count;
    float *room = malloc((n + 1) * PIECE * sizeof *room);
    if (!room) return fail(MERLIN_NO_MEMORY, "no memory for the sums of %d ranks", r->count);
    while (count >= n) {
        size_t piece = count / n < PIECE ? count / n : PIECE;
        sum_round(r, values, piece, room);
        values += n * piece;
        count -= n * piece;
    }
    if (count) sum_rest(r, values, count, room);
    free(room);
    return OK;
}

void ranks_broadcast(const ranks *r, void *what, size_t bytes)
{
    if (!is_alone(r)) r->broadcast(what, bytes);
}

status ranks_agree(const ranks *r, status s)
{
    if (is_alone(r)) return s;
    int mine = (int)s, *all = malloc((size_t)r->count * sizeof *all), first = 0;
    if (!all) { /* the others would wait forever */
        r->abort_all();
        return fail(MERLIN_NO_MEMORY, "no memory to hear from %d ranks", r->count);
    }
    r->all_gather(&mine, all, sizeof mine);
    while (first < r->count && all[first] == (int)OK)
        first++;
    free(all);
    if (first == r->count) return OK;
    return first == r->index ? s : STATUS_ELSEWHERE;
}
