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

typedef struct chosen {
    size_t place;
    bool first; /* where its way is first come by */
} chosen;

static int by_place(const void *a, const void *b)
{
    return ((const chosen *)a)->place < ((const chosen *)b)->place ? -1 : 1;
}

/* Chooses of count places those where a new way is first come by and where last; returns how many. */
static size_t choose(size_t count, chosen *out)
{
    size_t kept = 0, *places = calloc(count, sizeof *places);
    assert_non_null(places);
    for (size_t i = 0; i < count; i++)
        places[i] = i + 1;
    qsort(places, count, sizeof *places, by_way);
    for (size_t first = 0, next; first < count; first = next) {
        const uint64_t way = failing_memory_way(places[first]);
        for (next = first + 1; next < count && failing_memory_way(places[next]) == way;)
            next++;
        if (!take(way)) continue;
        out[kept++] = (chosen){places[first], true};
        if (next - 1 > first) out[kept++] = (chosen){places[next - 1], false};
    }
    free(places);
    qsort(out, kept, sizeof *out, by_place);
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

/* Of so many ways there is one where all that follow fail, too, which shows what words and tidying up ask for. */
enum { SHARE_BEHIND = 3 };

void some_allocations_fail(const memory_trial *t, size_t every)
{
    failing_memory_count();
    int result = t->run(t->context), faults = 0;
    size_t count = failing_memory_end();
    if (result != OK) fail_msg("%s: %s", t->name, status_message());
    assert_null(t->check(t->context, result));
    chosen *all = calloc(count, sizeof *all);
    assert_non_null(all);
    const size_t number = choose(count, all);
    for (size_t i = 0; i < number; i += every) {
        faults += fails_here(t, all[i].place, false);
        if (all[i].first && i / every % SHARE_BEHIND == 0) faults += fails_here(t, all[i].place, true);
    }
    free(all);
    print_message("%s: %zu of %zu allocations failed, %d faults\n", t->name, (number + every - 1) / every, count,
                  faults);
    assert_int_equal(t->run(t->context), OK);
    assert_null(t->check(t->context, OK));
    assert_int_equal(faults, 0);
}

void each_allocation_fails(const memory_trial *t)
{
    some_allocations_fail(t, 1);
}
