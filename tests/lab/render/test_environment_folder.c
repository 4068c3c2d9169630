/* SPDX-License-Identifier: MIT */
/* --env-dir: environments from a folder of the user's. */
#include <string.h>

#include "base/file.h"
#include "image/exr/exr.h"
#include "lab/render/environment.h"

/* last, as cmocka defines a macro named fail */
#include "flat.h"

static void write_map(const char *name, int width, int height, float value)
{
    write_flat(name, width, height, 3, value, IMG_SRGB8);
}

static void maps_come_in_the_order_of_their_names_and_of_one_size(void **state)
{
    (void)state;
    write_map("b.png", 64, 32, 0);
    write_map("a.png", 512, 256, 1);
    environment_folder folder;
    assert_int_equal(environment_folder_read(scratch, &folder), OK);
    assert_int_equal(folder.count, 2);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(folder.maps[i].width, folder.maps[0].width);
        assert_int_equal(folder.maps[i].height, folder.maps[0].height);
    }
    assert_float_equal(folder.maps[0].data[0], 1, 1e-6);
    assert_float_equal(folder.maps[1].data[0], 0, 1e-6);
    environment_folder_free(&folder);
}

static void a_map_that_is_no_latitude_longitude_picture_is_refused_by_name(void **state)
{
    (void)state;
    write_map("a.png", 64, 32, 1);
    write_map("ball.png", 64, 64, 1);
    environment_folder folder;
    assert_int_equal(environment_folder_read(scratch, &folder), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "ball.png is 64×64 pixels"));
    assert_null(folder.maps);
}

/* Writes a map of one value, with another at a texel in the middle. */
static void write_odd_map(const char *name, int width, int height, float value, float odd)
{
    img map;
    assert_int_equal(img_new(&map, width, height, 3), OK);
    for (size_t i = 0; i < img_value_count(&map); i++)
        map.data[i] = value;
    for (int c = 0; c < 3; c++)
        img_at(&map, width / 2, height / 2)[c] = odd;
    const exr_channel channels[] = {
        {"R", map.data, 3, true}, {"G", map.data + 1, 3, true}, {"B", map.data + 2, 3, true}};
    assert_int_equal(exr_write(scratch_path(name), width, height, channels, 3, NULL, 0), OK);
    img_free(&map);
}

static void a_negative_value_is_black_and_takes_nothing_from_those_beside_it(void **state)
{
    (void)state;
    write_odd_map("large.exr", 2 * ENVIRONMENT_WIDTH, 2 * ENVIRONMENT_HEIGHT, 1, -1000);
    write_odd_map("small.exr", ENVIRONMENT_WIDTH / 4, ENVIRONMENT_HEIGHT / 4, 1, -1000);
    environment_folder folder;
    assert_int_equal(environment_folder_read(scratch, &folder), OK);
    /* one of four texels is black */
    assert_float_equal(img_at(&folder.maps[0], ENVIRONMENT_WIDTH / 2, ENVIRONMENT_HEIGHT / 2)[0], 0.75f, 1e-5);
    /* enlarging overshoots beside an edge, by less than half of the step */
    for (size_t i = 0; i < img_value_count(&folder.maps[1]); i++)
        assert_in_range((int)(1000 * folder.maps[1].data[i]), 0, 1500);
    environment_folder_free(&folder);
}

static void maps_are_told_by_content_and_others_are_listed(void **state)
{
    (void)state;
    write_map("a", 64, 32, 1);
    write_map("b.jfif", 64, 32, 1);
    assert_int_equal(file_write(scratch_path("c.jxl"), "\xff\x0a and more", 11), OK);
    environment_folder folder;
    assert_int_equal(environment_folder_read(scratch, &folder), OK);
    assert_int_equal(folder.count, 2);
    assert_int_equal(folder.skipped.count, 1);
    assert_string_equal(folder.skipped.at[0].name, "c.jxl");
    assert_string_equal(folder.skipped.at[0].why, "JPEG XL is not read");
    environment_folder_free(&folder);
}

static void a_folder_without_maps_is_refused(void **state)
{
    (void)state;
    environment_folder folder;
    assert_int_equal(environment_folder_read(scratch, &folder), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "no environment maps"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        in_scratch(maps_come_in_the_order_of_their_names_and_of_one_size),
        in_scratch(a_map_that_is_no_latitude_longitude_picture_is_refused_by_name),
        in_scratch(a_negative_value_is_black_and_takes_nothing_from_those_beside_it),
        in_scratch(maps_are_told_by_content_and_others_are_listed),
        in_scratch(a_folder_without_maps_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
