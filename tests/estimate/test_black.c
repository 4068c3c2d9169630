/* The relighting decoder's black level. */
#include "estimate/black.h"

/* last: it claims the word fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static void black_becomes_zero_and_white_stays_one(void **state)
{
    (void)state;
    float data[] = {0, RELIT_BLACK, 0.5f * (1 + RELIT_BLACK), 1};
    img image = {.width = 4, .height = 1, .channels = 1, .data = data};
    relit_black_level(&image);
    assert_true(data[0] == 0 && data[1] == 0);
    assert_float_equal(data[2], 0.5f, 1e-6);
    assert_float_equal(data[3], 1, 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(black_becomes_zero_and_white_stays_one)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
