/* SPDX-License-Identifier: MIT */
#include <stdlib.h>

#include "lab/train/config/schedule.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static void rate_warms_up_and_halves_every_so_many_epochs(void **unused)
{
    (void)unused;
    train_config c = {.batch = 10, .learning_rate = 0.8, .halve_every_epochs = 2, .warmup_steps = 4};
    const size_t epoch = 100;
    assert_float_equal(train_learning_rate(&c, epoch, 0), 0.2, 1e-12);
    assert_float_equal(train_learning_rate(&c, epoch, 20), 0.6, 1e-12);
    assert_float_equal(train_learning_rate(&c, epoch, 30), 0.8, 1e-12);
    assert_float_equal(train_learning_rate(&c, epoch, 190), 0.8, 1e-12);
    assert_float_equal(train_learning_rate(&c, epoch, 200), 0.4, 1e-12);
    assert_float_equal(train_learning_rate(&c, epoch, 399), 0.4, 1e-12);
    assert_float_equal(train_learning_rate(&c, epoch, 400), 0.2, 1e-12);
    c.halve_every_epochs = 0;
    assert_float_equal(train_learning_rate(&c, epoch, 4000), 0.8, 1e-12);
}

static void every_epoch_presents_every_sample_once(void **unused)
{
    (void)unused;
    enum { COUNT = 57 };
    train_order o;
    assert_int_equal(train_order_new(&o, 3, COUNT), OK);
    size_t first[COUNT];
    int moved = 0;
    for (uint64_t epoch = 0; epoch < 3; epoch++) {
        int seen[COUNT] = {0};
        for (uint64_t i = 0; i < COUNT; i++) {
            size_t k = train_order_at(&o, epoch * COUNT + i);
            assert_true(k < COUNT);
            seen[k]++;
            if (epoch == 0) first[i] = k;
            if (epoch == 1) moved += first[i] != k;
        }
        for (int k = 0; k < COUNT; k++)
            assert_int_equal(seen[k], 1);
    }
    assert_true(moved > COUNT / 2); /* another epoch, another order */
    for (uint64_t i = 0; i < COUNT; i++)
        assert_int_equal(train_order_at(&o, i), first[i]); /* and back */
    train_order_free(&o);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rate_warms_up_and_halves_every_so_many_epochs),
        cmocka_unit_test(every_epoch_presents_every_sample_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
