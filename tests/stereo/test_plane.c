/* SPDX-License-Identifier: MIT */
/* Pictures of few values are kept in a byte each, and are the same. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/rng.h"
#include "stereo/capture/plane.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

enum { COUNT = 3000 };

/* Draws codes of so many levels from `least` on. */
static uint16_t *draw(int levels, int least, uint32_t seed)
{
    uint16_t *codes = malloc(COUNT * sizeof *codes);
    rng r = rng_at(seed, 0, 0);
    assert_non_null(codes);
    for (int i = 0; i < COUNT; i++)
        codes[i] = (uint16_t)(least + 200 * (i < levels ? i : rng_below(&r, levels)));
    return codes;
}

static pst_plane take(const uint16_t *codes)
{
    pst_plane p;
    uint16_t *copy = malloc(COUNT * sizeof *copy);
    assert_non_null(copy);
    memcpy(copy, codes, COUNT * sizeof *copy);
    pst_plane_take(copy, COUNT, &p);
    return p;
}

static void check_codes(const pst_plane *p, const uint16_t *codes)
{
    uint16_t buffer[100];
    for (size_t i = 0; i < COUNT; i++)
        assert_int_equal(pst_code(p, i), codes[i]);
    assert_memory_equal(pst_codes(p, 1234, 100, buffer), codes + 1234, sizeof buffer);
}

static void few_values_take_a_byte_each(void **state)
{
    /* 255 levels beside 0, which has a place whether it occurs or not; 256 with it */
    const struct {
        int levels, least;
        bool narrow;
    } cases[] = {{1, 0, true}, {1, 65535, true}, {255, 7, true}, {256, 7, false}, {256, 0, true}, {257, 0, false}};
    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        uint16_t *codes = draw(cases[k].levels, cases[k].least, 1);
        pst_plane p = take(codes);
        assert_int_equal(p.narrow != NULL, cases[k].narrow);
        assert_int_equal(p.wide != NULL, !cases[k].narrow);
        assert_int_equal(pst_plane_bytes(&p), cases[k].narrow ? 1 : 2);
        check_codes(&p, codes);
        memset(pst_plane_data(&p), 0, 100 * pst_plane_bytes(&p));
        assert_int_equal(pst_code(&p, 99), 0);
        assert_int_equal(pst_code(&p, 100), codes[100]);
        pst_plane_free(&p);
        assert_null(pst_plane_data(&p));
        free(codes);
    }
}

static void planes_can_be_widened(void **state)
{
    uint16_t *codes = draw(200, 7, 2);
    pst_plane p = take(codes);
    (void)state;
    assert_int_equal(pst_plane_widen(&p, COUNT), OK);
    assert_null(p.narrow);
    assert_memory_equal(p.wide, codes, COUNT * sizeof *codes);
    assert_int_equal(pst_plane_widen(&p, COUNT), OK);
    pst_plane_free(&p);
    free(codes);
}

static void equal_codes_make_equal_planes(void **state)
{
    uint16_t *codes = draw(200, 7, 3);
    pst_plane a = take(codes), b = take(codes), wide = {.wide = codes};
    (void)state;
    assert_true(pst_plane_equals(&a, &b, COUNT));
    assert_true(pst_plane_equals(&a, &wide, COUNT));
    codes[COUNT - 1] = 30000;
    pst_plane other = take(codes);
    assert_false(pst_plane_equals(&a, &other, COUNT));
    assert_false(pst_plane_equals(&a, &wide, COUNT));
    assert_true(pst_plane_equals(&other, &wide, COUNT));
    assert_true(pst_plane_equals(&a, &other, COUNT - 1));
    pst_plane_free(&a);
    pst_plane_free(&b);
    pst_plane_free(&other);
    pst_plane_free(&wide);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(few_values_take_a_byte_each),
        cmocka_unit_test(planes_can_be_widened),
        cmocka_unit_test(equal_codes_make_equal_planes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
