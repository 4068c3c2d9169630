/* SPDX-License-Identifier: MIT */
/* How unlike the border: even and shaded backgrounds, objects inside and cut off. */
#include "estimate/object/border_distance.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

enum { SIDE = 40 };

typedef struct scene {
    img color, away;
    uint8_t ring[SIDE * SIDE];
} scene;

/* Grey of 0.2 at the top to 0.2 + shading at the bottom, the ring a pixel wide. */
static void scene_new(scene *s, float shading)
{
    assert_int_equal(img_new(&s->color, SIDE, SIDE, 3), OK);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            s->ring[y * SIDE + x] = x == 0 || y == 0 || x == SIDE - 1 || y == SIDE - 1;
            for (int c = 0; c < 3; c++)
                img_at(&s->color, x, y)[c] = 0.2f + shading * (float)y / (SIDE - 1);
        }
}

static bool in_square(int x, int y, int top)
{
    return x >= 12 && x < 28 && y >= top && y < top + 16;
}

static void put_square(scene *s, int top)
{
    for (int y = top; y < top + 16 && y < SIDE; y++)
        for (int x = 12; x < 28; x++)
            for (int c = 0; c < 3; c++)
                img_at(&s->color, x, y)[c] = 0.7f;
}

static void measure(scene *s)
{
    assert_int_equal(border_distance(&s->color, s->ring, &s->away), OK);
}

static void scene_free(scene *s)
{
    img_free(&s->color);
    img_free(&s->away);
}

/* 0.5 in each of three channels; background costs nothing. */
static void square_stands_out(const scene *s, int top)
{
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            assert_float_equal(*img_at(&s->away, x, y), in_square(x, y, top) ? 1.5f : 0, 1e-6);
}

static void an_object_stands_out_by_the_step_of_its_outline(void **state)
{
    (void)state;
    scene s;
    scene_new(&s, 0);
    put_square(&s, 12);
    measure(&s);
    square_stands_out(&s, 12);
    scene_free(&s);
}

static void an_object_that_one_side_cuts_off_is_no_background(void **state)
{
    (void)state;
    scene s;
    scene_new(&s, 0);
    put_square(&s, SIDE - 10);
    measure(&s);
    square_stands_out(&s, SIDE - 10);
    scene_free(&s);
}

static void a_shaded_background_is_all_background(void **state)
{
    (void)state;
    scene s;
    scene_new(&s, 0.6f);
    measure(&s);
    for (int i = 0; i < SIDE * SIDE; i++)
        assert_float_equal(s.away.data[i], 0, 1e-6);
    scene_free(&s);
}

/* No side's colour is on another: the whole border is taken for background then, not nothing. */
static void a_border_of_four_colours_is_background(void **state)
{
    (void)state;
    scene s;
    scene_new(&s, 0);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            const int away[4] = {x, SIDE - 1 - x, y, SIDE - 1 - y};
            for (int k = 0, best = SIDE; k < 4; k++)
                if (away[k] < best) {
                    best = away[k];
                    img_at(&s.color, x, y)[0] = 0.25f * (float)k;
                }
        }
    measure(&s);
    for (int i = 0; i < SIDE * SIDE; i++)
        assert_float_equal(s.away.data[i], 0, 1e-6);
    scene_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_object_stands_out_by_the_step_of_its_outline),
        cmocka_unit_test(an_object_that_one_side_cuts_off_is_no_background),
        cmocka_unit_test(a_shaded_background_is_all_background),
        cmocka_unit_test(a_border_of_four_colours_is_background),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
