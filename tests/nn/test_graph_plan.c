/* SPDX-License-Identifier: MIT */
/* The memory planner, on random lifetimes. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/rng.h"
#include "nn/plan.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

enum { TRIALS = 200, MOST = 120, STEPS = 60 };

static size_t random_plan(uint64_t trial, plan_buffer *buffers)
{
    rng random = rng_at(3, trial, 0);
    size_t count = 1 + (size_t)rng_below(&random, MOST);
    for (size_t i = 0; i < count; i++) {
        int first = rng_below(&random, STEPS), length = rng_below(&random, i % 5 ? 6 : STEPS);
        buffers[i] = (plan_buffer){.bytes = (size_t)rng_below(&random, 5000), .first = first, .last = first + length};
    }
    return count;
}

static void buffers_alive_together_never_overlap(void **state)
{
    (void)state;
    for (uint64_t trial = 0; trial < TRIALS; trial++) {
        plan_buffer b[MOST];
        size_t size, count = random_plan(trial, b);
        assert_int_equal(plan_memory(b, count, &size), OK);
        for (size_t i = 0; i < count; i++) {
            assert_int_equal(b[i].offset % PLAN_ALIGNMENT, 0);
            assert_true(b[i].offset + b[i].bytes <= size);
            for (size_t k = 0; k < i; k++) {
                bool together = b[i].first <= b[k].last && b[k].first <= b[i].last;
                bool apart = b[i].offset + b[i].bytes <= b[k].offset || b[k].offset + b[k].bytes <= b[i].offset;
                assert_true(!together || apart);
            }
        }
    }
}

/* No plan can be smaller than what is alive at one step; a good one is not much larger. */
static void plans_are_near_the_bound(void **state)
{
    (void)state;
    double total = 0, bound = 0;
    for (uint64_t trial = 0; trial < TRIALS; trial++) {
        plan_buffer b[MOST];
        size_t size, most = 0, count = random_plan(trial, b);
        assert_int_equal(plan_memory(b, count, &size), OK);
        for (int t = 0; t < 2 * STEPS; t++) {
            size_t alive = 0;
            for (size_t i = 0; i < count; i++)
                if (b[i].first <= t && t <= b[i].last) alive += b[i].bytes;
            if (alive > most) most = alive;
        }
        assert_true(size >= most);
        total += (double)size;
        bound += (double)most;
    }
    assert_true(total < 1.15 * bound); /* greedy by size stays within some percent of the bound on such lifetimes */
}

static void plans_are_reproducible(void **state)
{
    (void)state;
    plan_buffer a[MOST], b[MOST];
    size_t count = random_plan(11, a), size_a, size_b;
    random_plan(11, b);
    assert_int_equal(plan_memory(a, count, &size_a), OK);
    assert_int_equal(plan_memory(b, count, &size_b), OK);
    assert_int_equal(size_a, size_b);
    for (size_t i = 0; i < count; i++)
        assert_int_equal(a[i].offset, b[i].offset);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(buffers_alive_together_never_overlap),
        cmocka_unit_test(plans_are_near_the_bound),
        cmocka_unit_test(plans_are_reproducible),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
