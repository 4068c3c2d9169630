/* SPDX-License-Identifier: MIT */
/* Numbers for paths: every square block of pixels covers the unit square evenly. */
#include "lab/render/sequence.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { SIDE = 8, CELLS = SIDE * SIDE };

/* Counts the points of `paths` paths in each of block² pixels by cells of `columns` × (CELLS / columns). */
static void count_points(const sequence *q, int pair, int x0, int y0, int block, int paths, int columns, int *cells)
{
    for (int k = 0; k < CELLS; k++)
        cells[k] = 0;
    for (int y = y0; y < y0 + block; y++)
        for (int x = x0; x < x0 + block; x++)
            for (int i = 0; i < paths; i++) {
                path_start s = sequence_at(q, pair, sequence_index(x, y) * (uint32_t)paths + (uint32_t)i);
                assert_true(s.u1 >= 0 && s.u1 < 1 && s.u2 >= 0 && s.u2 < 1);
                int column = (int)(s.u1 * (float)columns), row = (int)(s.u2 * (float)(CELLS / columns));
                cells[row * columns + column]++;
            }
}

static void a_block_of_paths_puts_one_point_into_every_cell_of_any_shape(void **state)
{
    (void)state;
    rng r = rng_at(3, 1, 4);
    sequence q = sequence_of(&r);
    for (int pair = 0; pair < SEQUENCE_PAIRS; pair++)
        for (int columns = 1; columns <= CELLS; columns *= 2) {
            int cells[CELLS];
            count_points(&q, pair, 12, 20, 4, 4, columns, cells);
            for (int k = 0; k < CELLS; k++)
                assert_int_equal(cells[k], 1);
        }
}

static void pairs_of_a_path_are_not_alike(void **state)
{
    (void)state;
    rng r = rng_at(3, 1, 5);
    sequence q = sequence_of(&r);
    enum { POINTS = 4096 };
    double product = 0;
    for (uint32_t i = 0; i < POINTS; i++)
        product += (sequence_at(&q, SEQUENCE_DIRECTION, i).u1 - 0.5f) * (sequence_at(&q, SEQUENCE_LIGHT, i).u1 - 0.5f);
    /* for independent numbers the mean deviates by 1/12/sqrt(4096) = 0.0013 */
    assert_true(product / POINTS > -0.005 && product / POINTS < 0.005);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_block_of_paths_puts_one_point_into_every_cell_of_any_shape),
        cmocka_unit_test(pairs_of_a_path_are_not_alike),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
