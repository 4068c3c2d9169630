/* SPDX-License-Identifier: MIT */
#include "each_allocation.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "failing_memory.h"

/* last, as cmocka defines a macro named fail */
#include <cmocka.h>

/* ---- which allocations ---- */

static int by_way(const void *a, const void *b)
{
    uint64_t one = failing_memory_way(*(const size_t *)a), other = failing_memory_way(*(const size_t *)b);
    if (one != other) return one < other ? -1 : 1;
    return *(const size_t *)a < *(const size_t *)b ? -1 : 1;
}

static int by_place(const void *a, const void *b)
{
    return *(const size_t *)a < *(const size_t *)b ? -1 : 1;
}

/* Ways that earlier trials of this program have taken. */
enum { MOST_TAKEN = 1 << 16 };
static uint64_t taken[MOST_TAKEN]; /* by its lowest bits, or behind; 0: free */

/* Tells if a way is new, which it then no longer is. */
static bool take(uint64_t way)
{
    for (size_t i = 0; i < MOST_TAKEN; i++) {
        uint64_t *here = &taken[(way + i) % MOST_TAKEN];
        if (*here == way) return false;
        if (*here) continue;
        *here = way;
        return true;
    }
    return true;
}

/* Leaves of count places those where a new way is first come by and where last; returns how many. */
static size_t choose(size_t *places, size_t count)
{
    size_t kept = 0;
    qsort(places, count, sizeof *places, by_way);
    for (size_t first = 0, next; first < count; first = next) {
        const uint64_t way = failing_memory_way(places[first]);
        for (next = first + 1; next < count && failing_memory_way(places[next]) == way;)
            next++;
        const size_t ends[2] = {places[first], places[next - 1]};
        if (!take(way)) continue;
        places[kept++] = ends[0];
        if (ends[1] != ends[0]) places[kept++] = ends[1];
    }
    qsort(places, kept, sizeof *places, by_place);
    return kept;
}

/* ---- what becomes of it ---- */

/* Returns what is wrong, or NULL. */
static const char *fault_of(const memory_trial *t, int result)
{
    const char *left = t->check(t->context, result);
    if (left) return left;
    if (result == OK) return NULL;
    if (result != MERLIN_NO_MEMORY) return "another status than that of no memory";
    return strstr(status_message(), "memory") ? NULL : "words that say nothing of memory";
}

/* Returns how many faults. */
static int fails_here(const memory_trial *t, size_t n, bool and_all_behind)
{
    (void)(fail)(OK, "nothing was said");
    failing_memory_begin(n, and_all_behind);
    int result = t->run(t->context);
    failing_memory_end();
    const char *fault = fault_of(t, result);
    if (!fault) return 0;
    print_error("%s: allocation %zu fails%s: %s; status %d, \"%s\"; from", t->name, n,
                and_all_behind ? " with all behind it" : "", fault, result, status_message());
    failing_memory_print_way(n);
    return 1;
}

void each_allocation_fails(const memory_trial *t)
{
    failing_memory_count();
    int result = t->run(t->context), faults = 0;
    size_t count = failing_memory_end();
    if (result != OK) fail_msg("%s: %s", t->name, status_message());
    assert_null(t->check(t->context, result));
    size_t *places = calloc(count, sizeof *places);
    assert_non_null(places);
    for (size_t i = 0; i < count; i++)
        places[i] = i + 1;
    size_t chosen = choose(places, count);
    for (size_t i = 0; i < chosen; i++)
        faults += fails_here(t, places[i], false) + fails_here(t, places[i], true);
    free(places);
    print_message("%s: %zu of %zu allocations failed, %d faults\n", t->name, chosen, count, faults);
    assert_int_equal(t->run(t->context), OK);
    assert_null(t->check(t->context, OK));
    assert_int_equal(faults, 0);
}
