/* SPDX-License-Identifier: MIT */
/* Sums over several processes have one order and are the same in all, whatever the number and size of the processes'
 * parts. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "base/ranks/ranks.h"

enum { RANKS = 3, MOST = 1000003 };

/* Defined before cmocka's macro fail. */
static status failure_of(int rank)
{
    return fail(MERLIN_BAD_INPUT, "rank %d", rank);
}

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

#include "forked_ranks.h"

static double part(int rank, size_t i)
{
    static const double of[RANKS] = {1e16, 1, -1e16};
    return i == 0 ? of[rank] : 0.1 * (double)(rank + 1) * (double)(i % 97);
}

static void sum_doubles(ranks *r, void *context)
{
    double *all = context, *mine = all + 5 * (size_t)r->index;
    for (size_t i = 0; i < 5; i++)
        mine[i] = part(r->index, i);
    if (ranks_sum(r, mine, 5) != OK) ranks_abort(r);
}

/* The order is from the first to the last: (1e16 + 1) - 1e16 is 0 in doubles, where another order gives 1. */
static void doubles_are_added_in_the_order_of_ranks(void **state)
{
    (void)state;
    double *all = forked_memory(RANKS * 5 * sizeof *all);
    assert_int_equal(forked_run(RANKS, sum_doubles, all), RANKS);
    for (size_t i = 0; i < 5; i++) {
        double sum = 0;
        for (int k = 0; k < RANKS; k++)
            sum += part(k, i);
        for (size_t k = 0; k < RANKS; k++)
            assert_true(all[5 * k + i] == sum);
    }
}

typedef struct floats {
    size_t count;
    float *all; /* values of each rank, MOST apart */
} floats;

static void sum_floats(ranks *r, void *context)
{
    const floats *f = context;
    float *mine = f->all + MOST * (size_t)r->index;
    for (size_t i = 0; i < f->count; i++)
        mine[i] = (float)part(r->index, i + 1);
    if (ranks_sum_floats(r, mine, f->count) != OK) ranks_abort(r);
}

static void floats_of_any_number_are_added_in_double(void **state)
{
    static const size_t counts[] = {1, 2, 3, 5, 7, 1000, 393216, 393219, MOST};
    floats f = {0, forked_memory((size_t)RANKS * MOST * sizeof *f.all)};
    (void)state;
    for (size_t n = 0; n < sizeof counts / sizeof *counts; n++) {
        f.count = counts[n];
        assert_int_equal(forked_run(RANKS, sum_floats, &f), RANKS);
        for (size_t i = 0; i < f.count; i++) {
            double sum = 0;
            for (int k = 0; k < RANKS; k++)
                sum += (double)(float)part(k, i + 1);
            for (size_t k = 0; k < RANKS; k++)
                assert_true(f.all[k * MOST + i] == (float)sum);
        }
    }
}

static void fail_some(ranks *r, void *context)
{
    int *results = context;
    results[r->index] = (int)ranks_agree(r, r->index > 0 ? failure_of(r->index) : OK);
    results[RANKS + r->index] = r->index == 1 && strcmp(status_message(), "rank 1") == 0;
    results[2 * RANKS + r->index] = (int)ranks_agree(r, OK);
}

static void all_hear_that_one_has_failed(void **state)
{
    (void)state;
    int *results = forked_memory(3 * RANKS * sizeof *results);
    assert_int_equal(forked_run(RANKS, fail_some, results), RANKS);
    const int wanted[3 * RANKS] = {STATUS_ELSEWHERE, MERLIN_BAD_INPUT, STATUS_ELSEWHERE, 0, 1, 0, OK, OK, OK};
    assert_memory_equal(results, wanted, sizeof wanted);
}

static void what_the_first_has_reaches_all_and_one_alone_needs_nobody(void **state)
{
    double values[] = {1, 2};
    float some[] = {3, 4};
    (void)state;
    assert_int_equal(ranks_count(NULL), 1);
    assert_int_equal(ranks_index(NULL), 0);
    assert_int_equal(ranks_sum(NULL, values, 2), OK);
    assert_int_equal(ranks_sum_floats(NULL, some, 2), OK);
    assert_int_equal(ranks_agree(NULL, MERLIN_NO_MEMORY), MERLIN_NO_MEMORY);
    ranks_broadcast(NULL, values, sizeof values);
    assert_true(values[0] == 1 && values[1] == 2 && some[0] == 3 && some[1] == 4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(doubles_are_added_in_the_order_of_ranks),
        cmocka_unit_test(floats_of_any_number_are_added_in_double),
        cmocka_unit_test(all_hear_that_one_has_failed),
        cmocka_unit_test(what_the_first_has_reaches_all_and_one_alone_needs_nobody),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
