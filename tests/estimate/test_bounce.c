/* SPDX-License-Identifier: MIT */
#include "estimate/light/bounce.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

enum { SIDE = 128, VALUES = 3 * SIDE * SIDE, RADIUS = SIDE / 32 };

typedef struct pictures {
    img flash, light, indirect;
} pictures;

/* All lit by the flash, columns from `lit` on by the light, bounces of 0.2 everywhere. */
static void pictures_new(pictures *p, int lit)
{
    img *images[] = {&p->flash, &p->light, &p->indirect};
    for (int k = 0; k < 3; k++)
        assert_int_equal(img_new(images[k], SIDE, SIDE, 3), OK);
    for (int i = 0; i < VALUES; i++) {
        p->flash.data[i] = 0.5f;
        p->light.data[i] = i / 3 % SIDE >= lit ? 0.5f : 0;
        p->indirect.data[i] = 0.2f;
    }
}

static void pictures_free(pictures *p)
{
    img_free(&p->flash);
    img_free(&p->light);
    img_free(&p->indirect);
}

static void bounces_under_the_flash_stay(void **state)
{
    (void)state;
    pictures p = {0};
    pictures_new(&p, 0);
    assert_int_equal(bounce_follow(&p.flash, &p.light, NULL, &p.indirect), OK);
    for (int i = 0; i < VALUES; i++)
        assert_true(p.indirect.data[i] == 0.2f);
    pictures_free(&p);
}

static void bounces_end_where_nothing_around_is_lit(void **state)
{
    (void)state;
    pictures p = {0};
    pictures_new(&p, SIDE / 2);
    assert_int_equal(bounce_follow(&p.flash, &p.light, NULL, &p.indirect), OK);
    for (int x = 0; x < SIDE; x++) {
        float left = *img_at(&p.indirect, x, SIDE / 3);
        if (x < SIDE / 2 - RADIUS) assert_true(left == 0);
        if (x >= SIDE / 2 + RADIUS) assert_true(left == 0.2f);
        if (x > SIDE / 2 - RADIUS && x < SIDE / 2 + RADIUS) assert_true(left > 0 && left < 0.2f);
    }
    pictures_free(&p);
}

static void surroundings_count_as_light(void **state)
{
    (void)state;
    pictures p = {0};
    pictures_new(&p, SIDE);
    img *ambient = &p.flash; /* as bright as the flash itself */
    assert_int_equal(bounce_follow(&p.flash, &p.light, ambient, &p.indirect), OK);
    for (int i = 0; i < VALUES; i++)
        assert_true(p.indirect.data[i] == 0.2f);
    pictures_free(&p);
}

static void a_brighter_light_adds_no_bounces_and_black_pictures_give_none(void **state)
{
    (void)state;
    pictures p = {0};
    pictures_new(&p, 0);
    for (int i = 0; i < VALUES; i++)
        p.light.data[i] *= 3;
    assert_int_equal(bounce_follow(&p.flash, &p.light, NULL, &p.indirect), OK);
    for (int i = 0; i < VALUES; i++) {
        assert_true(p.indirect.data[i] == 0.2f);
        p.flash.data[i] = p.light.data[i] = 0;
    }
    assert_int_equal(bounce_follow(&p.flash, &p.light, NULL, &p.indirect), OK);
    for (int i = 0; i < VALUES; i++)
        assert_true(p.indirect.data[i] >= 0 && p.indirect.data[i] <= 0.2f);
    pictures_free(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bounces_under_the_flash_stay),
        cmocka_unit_test(bounces_end_where_nothing_around_is_lit),
        cmocka_unit_test(surroundings_count_as_light),
        cmocka_unit_test(a_brighter_light_adds_no_bounces_and_black_pictures_give_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
