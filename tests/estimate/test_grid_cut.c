/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "base/rng.h"
#include "estimate/object/grid_cut.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

static int64_t cost_of(const grid_cut *g, const uint8_t *object)
{
    int64_t cost = 0;
    for (size_t i = 0; i < (size_t)g->width * (size_t)g->height; i++) {
        if (g->toward[i] > 0 && !object[i]) cost += g->toward[i];
        if (g->toward[i] < 0 && object[i]) cost -= g->toward[i];
        for (int d = 0; d < GRID_DIRECTIONS; d += 2) {
            size_t j = grid_beside(g->width, g->height, i, d);
            if (j != SIZE_MAX && object[i] != object[j]) cost += g->tie[d][i];
        }
    }
    return cost;
}

static void fill(grid_cut *g, rng *r)
{
    for (size_t i = 0; i < (size_t)g->width * (size_t)g->height; i++) {
        g->toward[i] = rng_below(r, 41) - 20;
        for (int d = 0; d < GRID_DIRECTIONS; d += 2)
            g->tie[d][i] = rng_below(r, 12);
    }
}

/* Of all parts of a small picture; pixels that are not free stay as they are. */
static int64_t least_cost(const grid_cut *g, const uint8_t *fixed)
{
    const int count = g->width * g->height;
    int64_t least = INT64_MAX;
    for (uint32_t bits = 0; bits < 1u << count; bits++) {
        uint8_t object[16];
        int wrong = 0;
        for (int i = 0; i < count; i++) {
            object[i] = bits >> i & 1;
            wrong |= !g->free[i] && object[i] != fixed[i];
        }
        if (wrong) continue;
        int64_t cost = cost_of(g, object);
        least = cost < least ? cost : least;
    }
    return least;
}

static void no_cut_is_cheaper(void **state)
{
    (void)state;
    for (uint64_t k = 0; k < 60; k++) {
        grid_cut g, copy;
        uint8_t object[12] = {0};
        rng r = rng_at(7, k, 0);
        assert_int_equal(grid_cut_new(&g, k % 2 ? 4 : 3, k % 2 ? 3 : 4), OK);
        assert_int_equal(grid_cut_new(&copy, g.width, g.height), OK);
        fill(&g, &r);
        r = rng_at(7, k, 0);
        fill(&copy, &r);
        for (int i = 0; i < 12 && k % 3 == 2; i++) {
            copy.free[i] = g.free[i] = rng_below(&r, 3) > 0;
            object[i] = rng_below(&r, 2) > 0;
        }
        int64_t least = least_cost(&copy, object);
        assert_int_equal(grid_cut_solve(&g, object), OK);
        assert_int_equal(cost_of(&copy, object), least);
        grid_cut_free(&g);
        grid_cut_free(&copy);
    }
}

/* A disc that the pixels' own costs show with errors at one in seven, and ties that are weak along its outline. */
static void errors_within_a_disc_are_mended(void **state)
{
    (void)state;
    const int side = 96;
    grid_cut g;
    uint8_t object[96 * 96] = {0};
    assert_int_equal(grid_cut_new(&g, side, side), OK);
    for (int i = 0; i < side * side; i++) {
        int x = i % side - side / 2, y = i / side - side / 2, inside = x * x + y * y < 30 * 30;
        g.toward[i] = (inside != (rng_mix((uint64_t)i) % 7 == 0)) ? 10 : -10;
        for (int d = 0; d < GRID_DIRECTIONS; d += 2) {
            size_t j = grid_beside(side, side, (size_t)i, d);
            if (j == SIZE_MAX) continue;
            int u = (int)j % side - side / 2, v = (int)j / side - side / 2;
            g.tie[d][i] = inside == (u * u + v * v < 30 * 30) ? 8 : 1;
        }
    }
    assert_int_equal(grid_cut_solve(&g, object), OK);
    for (int i = 0; i < side * side; i++) {
        int x = i % side - side / 2, y = i / side - side / 2;
        assert_int_equal(object[i], x * x + y * y < 30 * 30);
    }
    grid_cut_free(&g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_cut_is_cheaper),
        cmocka_unit_test(errors_within_a_disc_are_mended),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
