/* SPDX-License-Identifier: MIT */
#include <string.h>

#include "image/read/read.h"

/* last, as cmocka defines a macro named fail */
#include "flat.h"

static const char *grey_picture(const char *name, int width, int height)
{
    return write_flat(name, width, height, 3, 0.5f, IMG_SRGB8);
}

static void pictures_twice_as_wide_as_high_are_environments(void **state)
{
    (void)state;
    static const int sizes[][2] = {{8, 4}, {64, 32}, {65, 32}, {64, 33}};
    for (int i = 0; i < 4; i++) {
        img map = {0};
        assert_int_equal(img_read_latlong(grey_picture("map.png", sizes[i][0], sizes[i][1]), &map), OK);
        assert_int_equal(map.width, sizes[i][0]);
        assert_int_equal(map.channels, 3);
        img_free(&map);
    }
}

static void other_shapes_are_refused_by_name_and_size(void **state)
{
    (void)state;
    img map = {0};
    assert_int_equal(img_read_latlong(grey_picture("ball.png", 32, 32), &map), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "ball.png is 32×32 pixels; a latitude-longitude picture"));
    assert_null(map.data);
    assert_int_equal(img_read_latlong(grey_picture("cross.png", 64, 48), &map), MERLIN_BAD_INPUT);
    assert_int_equal(img_read_latlong(grey_picture("dot.png", 6, 3), &map), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "8×4 at least"));
    assert_int_equal(img_read_latlong(scratch_path("none.png"), &map), MERLIN_BAD_INPUT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        in_scratch(pictures_twice_as_wide_as_high_are_environments),
        in_scratch(other_shapes_are_refused_by_name_and_size),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
