/* SPDX-License-Identifier: MIT */
/* Pictures for people to look at, by the public functions. */
#include "merlin/merlin.h"

#include "writes.h"

enum { WIDTH = 24, HEIGHT = 16 };

static merlin_image picture_of(int channels, float data[3 * WIDTH * HEIGHT])
{
    for (int i = 0; i < channels * WIDTH * HEIGHT; i++)
        data[i] = (float)(i * 37 % 256) / 255;
    return (merlin_image){WIDTH, HEIGHT, channels, data};
}

static void encoded_bytes_are_those_of_the_file(void **state)
{
    static const char *const names[] = {"a.png", "a.jpg"};
    (void)state;
    float data[3 * WIDTH * HEIGHT];
    const merlin_image picture = picture_of(3, data);
    for (int format = MERLIN_PNG; format <= MERLIN_JPEG; format++) {
        unsigned char *bytes;
        char *file;
        size_t size, file_size;
        const char *path = scratch_path(names[format]);
        assert_int_equal(merlin_image_encode(&picture, (merlin_image_format)format, &bytes, &size), MERLIN_OK);
        assert_int_equal(merlin_image_write(path, &picture), MERLIN_OK);
        assert_int_equal(file_read(path, 1 << 20, &file, &file_size), OK);
        assert_int_equal(size, file_size);
        assert_memory_equal(bytes, file, size);
        free(bytes);
        free(file);
    }
}

static void masks_are_read_back_as_they_were(void **state)
{
    static const char *const names[] = {"m.png", "m.webp"};
    (void)state;
    float data[3 * WIDTH * HEIGHT];
    merlin_image mask = picture_of(1, data), back;
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        data[i] = (float)(i / WIDTH > 4 && i % WIDTH > 7);
    for (int k = 0; k < 2; k++) {
        const char *path = scratch_path(names[k]);
        assert_int_equal(merlin_mask_write(&mask, path), MERLIN_OK);
        assert_int_equal(merlin_mask_read(path, &back), MERLIN_OK);
        assert_memory_equal(back.data, data, sizeof(float) * WIDTH * HEIGHT);
        merlin_image_free(&back);
    }
    assert_int_equal(merlin_mask_write(&mask, scratch_path("m.jpg")), MERLIN_WRONG_USE);
}

static void an_image_made_smaller_keeps_its_mean(void **state)
{
    (void)state;
    float data[3 * WIDTH * HEIGHT];
    const merlin_image picture = picture_of(3, data);
    merlin_image less;
    double before = 0, after = 0;
    assert_int_equal(merlin_image_resize(&picture, WIDTH / 4, HEIGHT / 4, &less), MERLIN_OK);
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        before += (double)data[i] / 16;
    for (int i = 0; i < 3 * WIDTH * HEIGHT / 16; i++)
        after += (double)less.data[i];
    assert_float_equal(before, after, 1e-3);
    merlin_image_free(&less);
    assert_int_equal(merlin_image_resize(&picture, 0, 4, &less), MERLIN_WRONG_USE);
    assert_null(less.data);
}

static void a_sheet_has_all_its_tiles(void **state)
{
    (void)state;
    float data[3 * WIDTH * HEIGHT];
    const merlin_image picture = picture_of(3, data);
    const merlin_tile tiles[] = {{"one", &picture}, {"two", &picture}, {"three", &picture}};
    merlin_image two, three;
    assert_int_equal(merlin_sheet_write(tiles, 2, 2, 64, scratch_path("2.png")), MERLIN_OK);
    assert_int_equal(merlin_sheet_write(tiles, 3, 2, 64, scratch_path("3.png")), MERLIN_OK);
    assert_int_equal(merlin_image_read(scratch_path("2.png"), &two, NULL), MERLIN_OK);
    assert_int_equal(merlin_image_read(scratch_path("3.png"), &three, NULL), MERLIN_OK);
    assert_true(two.width >= 128 && three.width == two.width && three.height >= two.height + 64);
    merlin_image_free(&two);
    merlin_image_free(&three);
    assert_int_equal(merlin_sheet_write(tiles, 0, 1, 64, scratch_path("0.png")), MERLIN_WRONG_USE);
    assert_int_equal(merlin_sheet_write(tiles, 2, 3, 64, scratch_path("0.png")), MERLIN_WRONG_USE);
    assert_false(file_exists(scratch_path("0.png")));
}

static void an_animation_takes_frames_of_its_size_alone(void **state)
{
    (void)state;
    float data[3 * WIDTH * HEIGHT];
    const merlin_image frame = picture_of(3, data), other = {HEIGHT, WIDTH, 3, data};
    merlin_animation *turn;
    assert_int_equal(merlin_animation_new(WIDTH, HEIGHT, 2, &turn), MERLIN_OK);
    assert_int_equal(merlin_animation_write(turn, scratch_path("none.webp"), 100), MERLIN_WRONG_USE);
    assert_int_equal(merlin_animation_add(turn, &other), MERLIN_WRONG_USE);
    assert_int_equal(merlin_animation_add(turn, &frame), MERLIN_OK);
    assert_int_equal(merlin_animation_add(turn, &frame), MERLIN_OK);
    assert_int_equal(merlin_animation_add(turn, &frame), MERLIN_WRONG_USE);
    assert_int_equal(merlin_animation_write(turn, scratch_path("turn.webp"), 0), MERLIN_WRONG_USE);
    assert_int_equal(merlin_animation_write(turn, scratch_path("turn.webp"), 100), MERLIN_OK);
    assert_true(file_exists(scratch_path("turn.webp")));
    merlin_animation_free(turn);
    merlin_animation_free(NULL);
    assert_int_equal(merlin_animation_new(0, 8, 2, &turn), MERLIN_WRONG_USE);
    assert_null(turn);
}

static void images_that_are_none_are_refused(void **state)
{
    (void)state;
    float data[3 * WIDTH * HEIGHT];
    const merlin_image none = {0}, picture = picture_of(3, data);
    const merlin_tile missing = {"none", &none};
    merlin_image out;
    unsigned char *bytes;
    size_t size;
    assert_int_equal(merlin_image_encode(&none, MERLIN_PNG, &bytes, &size), MERLIN_WRONG_USE);
    assert_int_equal(merlin_image_encode(&picture, (merlin_image_format)9, &bytes, &size), MERLIN_WRONG_USE);
    assert_null(bytes);
    assert_int_equal(merlin_image_resize(&none, 8, 8, &out), MERLIN_WRONG_USE);
    assert_int_equal(merlin_mask_write(&none, scratch_path("m.png")), MERLIN_WRONG_USE);
    assert_int_equal(merlin_sheet_write(&missing, 1, 1, 64, scratch_path("s.png")), MERLIN_WRONG_USE);
    assert_int_equal(merlin_image_write(scratch_path("a.tiff"), &picture), MERLIN_WRONG_USE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        in_scratch(encoded_bytes_are_those_of_the_file),  in_scratch(masks_are_read_back_as_they_were),
        in_scratch(an_image_made_smaller_keeps_its_mean), in_scratch(a_sheet_has_all_its_tiles),
        in_scratch(images_that_are_none_are_refused),     in_scratch(an_animation_takes_frames_of_its_size_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
