/* SPDX-License-Identifier: MIT */
/* Frames of numbered pictures and of videos (merlin/frames.h). */
#include <math.h>

#include "image/write/write.h"
#include "merlin/frames.h"
#include "merlin/pictures.h"

#include "writes.h"

enum { SIDE = 32 };

/* Writes a grey picture of this brightness. */
static void write_picture(const char *name, int side, float value)
{
    img picture;
    assert_int_equal(img_new(&picture, side, side, 3), OK);
    for (size_t i = 0; i < img_value_count(&picture); i++)
        picture.data[i] = value;
    assert_int_equal(merlin_image_write(scratch_path(name), &picture), OK);
    img_free(&picture);
}

/* Writes a mask whose upper part, this share, is the object. */
static void write_mask(const char *name, float share)
{
    img mask;
    assert_int_equal(img_new(&mask, SIDE, SIDE, 1), OK);
    for (int i = 0; i < SIDE * SIDE; i++)
        mask.data[i] = (float)i < share * SIDE * SIDE;
    assert_int_equal(merlin_mask_write(&mask, scratch_path(name)), OK);
    img_free(&mask);
}

/* Compares the numbers of all frames with a list such as "1 2 5", where "5m" is one with a mask. */
static void assert_numbers(merlin_frames *frames, const char *wanted)
{
    char words[256] = "";
    merlin_frame frame = {0};
    while (merlin_frames_next(frames, &frame) == OK && frame.image.data) {
        const size_t length = strlen(words);
        snprintf(words + length, sizeof words - length, "%s%ld%s", length ? " " : "", frame.number,
                 frame.mask.data ? "m" : "");
        merlin_frame_free(&frame);
    }
    assert_string_equal(words, wanted);
    merlin_frames_close(frames);
}

static void a_pattern_gives_its_pictures_in_order(void **state)
{
    (void)state;
    merlin_frames *frames;
    write_picture("frame_10.png", SIDE, 0.5f);
    write_picture("frame_9.png", SIDE, 0.5f);
    write_picture("frame_0012.png", SIDE, 0.5f);
    write_picture("other_1.png", SIDE, 0.5f);
    write_picture("frame_x1.png", SIDE, 0.5f);
    assert_int_equal(merlin_frames_are(scratch_path("frame_%04d.png")), 2);
    assert_int_equal(merlin_frames_open(scratch_path("frame_%04d.png"), NULL, &frames), OK);
    const merlin_frames_head *head = merlin_frames_about(frames);
    assert_int_equal(head->count, 3);
    assert_int_equal(head->missing, 1);
    assert_int_equal(head->first_gap, 11);
    assert_numbers(frames, "9 10 12");
    assert_int_equal(merlin_frames_open(scratch_path("frame_##.png"), NULL, &frames), OK);
    assert_numbers(frames, "9 10 12");
    assert_int_equal(merlin_frames_open(scratch_path("frame_%d.exr"), NULL, &frames), MERLIN_BAD_INPUT);
}

static void a_file_whose_name_is_a_pattern_is_that_file(void **state)
{
    (void)state;
    write_picture("100%done.png", SIDE, 0.5f);
    write_picture("a#.png", SIDE, 0.5f);
    assert_int_equal(merlin_frames_are(scratch_path("100%done.png")), 0);
    assert_int_equal(merlin_frames_are(scratch_path("a#.png")), 0);
    assert_int_equal(merlin_frames_are(scratch_path("a.png")), 0);
}

static void masks_beside_frames_are_theirs(void **state)
{
    (void)state;
    merlin_frames *frames;
    write_picture("f1.png", SIDE, 0.5f);
    write_picture("f2.png", SIDE, 0.5f);
    write_mask("f2_mask.png", 0.5f);
    assert_int_equal(merlin_frames_open(scratch, NULL, &frames), OK);
    assert_numbers(frames, "1 2m");
    assert_int_equal(merlin_frames_open(scratch_path("f%d.png"), NULL, &frames), OK);
    assert_numbers(frames, "1 2m");
    const char *const names[] = {scratch_path("f2_mask.png"), scratch_path("f2.png"), scratch_path("f1.png")};
    assert_int_equal(merlin_frames_open_pictures(names, 3, NULL, &frames), OK);
    assert_numbers(frames, "1 2m");
    /* a mask that is given is the first frame's, and replaces all others */
    write_mask("given.png", 0.25f);
    assert_int_equal(merlin_frames_open(scratch_path("f%d.png"), scratch_path("given.png"), &frames), OK);
    assert_numbers(frames, "1m 2");
}

static void a_folder_of_masks_goes_by_numbers(void **state)
{
    (void)state;
    merlin_frames *frames;
    write_picture("f1.png", SIDE, 0.5f);
    write_picture("f2.png", SIDE, 0.5f);
    write_picture("f3.png", SIDE, 0.5f);
    assert_int_equal(file_make_folder(scratch_path("masks")), OK);
    write_mask("masks/m0003.png", 0.5f);
    write_mask("masks/m0001.png", 0.5f);
    assert_int_equal(merlin_frames_open(scratch_path("f%d.png"), scratch_path("masks"), &frames), OK);
    assert_numbers(frames, "1m 2 3m");
    assert_int_equal(file_make_folder(scratch_path("others")), OK);
    write_mask("others/m9.png", 0.5f);
    assert_int_equal(merlin_frames_open(scratch_path("f%d.png"), scratch_path("others"), &frames), MERLIN_BAD_INPUT);
}

static void pictures_that_are_no_sequence_are_refused(void **state)
{
    (void)state;
    merlin_frames *frames;
    write_picture("cup.png", SIDE, 0.5f);
    assert_int_equal(merlin_frames_open(scratch, NULL, &frames), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "no number"));
    assert_null(frames);
    assert_int_equal(unlink(scratch_path("cup.png")), 0);
    write_picture("cup1.png", SIDE, 0.5f);
    write_picture("dish2.png", SIDE, 0.5f);
    assert_int_equal(merlin_frames_open(scratch, NULL, &frames), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "differ by the number alone"));
    assert_int_equal(unlink(scratch_path("dish2.png")), 0);
    write_picture("cup01.png", SIDE, 0.5f);
    assert_int_equal(merlin_frames_open(scratch, NULL, &frames), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "same number"));
}

static void frames_of_other_sizes_are_refused(void **state)
{
    (void)state;
    merlin_frames *frames;
    merlin_frame frame;
    write_picture("f1.png", SIDE, 0.5f);
    write_picture("f2.png", SIDE + 1, 0.5f);
    assert_int_equal(merlin_frames_open(scratch, NULL, &frames), OK);
    assert_int_equal(merlin_frames_next(frames, &frame), OK);
    merlin_frame_free(&frame);
    assert_int_equal(merlin_frames_about(frames)->width, SIDE);
    assert_int_equal(merlin_frames_next(frames, &frame), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "one size"));
    assert_null(frame.image.data);
    merlin_frames_close(frames);
}

static void a_video_that_was_written_is_read(void **state)
{
    (void)state;
    merlin_video *video;
    merlin_frames *frames;
    img picture;
    status s = merlin_video_create(scratch_path("a.mp4"), SIDE, SIDE, 12, &video);
    if (s == MERLIN_DEVICE_FAILED) {
        print_message("skipped: %s\n", status_message());
        skip();
    }
    assert_int_equal(s, OK);
    assert_int_equal(img_new(&picture, SIDE, SIDE, 3), OK);
    for (int i = 0; i < 3; i++)
        assert_int_equal(merlin_video_add(video, &picture), OK);
    img_free(&picture);
    assert_int_equal(merlin_video_finish(video, 1), OK);
    assert_int_equal(merlin_frames_are(scratch_path("a.mp4")), 1);
    assert_int_equal(file_make_folder(scratch_path("masks")), OK);
    write_mask("masks/2.png", 0.5f);
    assert_int_equal(merlin_frames_open(scratch_path("a.mp4"), scratch_path("masks"), &frames), OK);
    assert_int_equal(merlin_frames_about(frames)->video, 1);
    assert_true(fabs(merlin_frames_about(frames)->rate - 12) < 0.01);
    assert_numbers(frames, "1 2m 3");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        in_scratch(a_pattern_gives_its_pictures_in_order),
        in_scratch(a_file_whose_name_is_a_pattern_is_that_file),
        in_scratch(masks_beside_frames_are_theirs),
        in_scratch(a_folder_of_masks_goes_by_numbers),
        in_scratch(pictures_that_are_no_sequence_are_refused),
        in_scratch(frames_of_other_sizes_are_refused),
        in_scratch(a_video_that_was_written_is_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
