/* SPDX-License-Identifier: MIT */
/* Folders of pictures. */
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "image/read/folder.h"
/* last, as cmocka defines a macro named fail */
#include "flat.h"

static void write_text(const char *name, const char *text)
{
    assert_int_equal(file_write(scratch_path(name), text, strlen(text)), OK);
}

/* Writes white in the right half and black in the left, or a ramp, which no mask is. */
static void write_halves(const char *name, bool ramp)
{
    img p;
    assert_int_equal(img_new(&p, 8, 8, 1), OK);
    for (int i = 0; i < 64; i++)
        p.data[i] = ramp ? (float)i / 63 : (float)(i % 8 > 3);
    assert_int_equal(img_write_png(scratch_path(name), &p, IMG_LINEAR8), OK);
    img_free(&p);
}

static const img_folder_file *find(const img_folder *f, const char *name)
{
    for (size_t i = 0; i < f->count; i++)
        if (strcmp(f->at[i].name, name) == 0) return &f->at[i];
    return NULL;
}

static void assert_photo(const char *name, bool is)
{
    img_folder f;
    assert_int_equal(img_folder_read(scratch, &f), OK);
    const img_folder_file *file = find(&f, name);
    if (!file || img_folder_is_photo(file) != is) fail_msg("%s is %sa photograph", name, is ? "not " : "");
    img_folder_free(&f);
}

static void content_tells_what_a_picture_is(void **state)
{
    (void)state;
    static const char *const names[] = {"a.jfif", "b", "c.txt", "d.NRW", "e.jpe"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        write_flat(names[i], 4, 4, 3, 0.5f, IMG_SRGB8);
        assert_photo(names[i], true);
    }
    write_text("notes.txt", "no picture");
    assert_photo("notes.txt", false);
    write_text("f.jxl", "\xff\x0a and more");
    assert_photo("f.jxl", false);
}

/* Reading it then reports what is wrong, while skipping it would look like success. */
static void what_is_called_like_a_picture_but_is_damaged_counts_as_one(void **state)
{
    (void)state;
    write_text("a.JPG", "no picture");
    assert_photo("a.JPG", true);
}

static void copies_and_what_systems_leave_are_no_photographs(void **state)
{
    (void)state;
    write_flat("a.png~", 4, 4, 3, 0.5f, IMG_SRGB8);
    assert_photo("a.png~", false);
    write_flat("IMG_1.THM", 4, 4, 3, 0.5f, IMG_SRGB8);
    assert_photo("IMG_1.THM", false);
    write_flat("Thumbs.db", 4, 4, 3, 0.5f, IMG_SRGB8);
    write_flat(".a.png", 4, 4, 3, 0.5f, IMG_SRGB8);
    img_folder f;
    assert_int_equal(img_folder_read(scratch, &f), OK);
    assert_int_equal(f.count, 2);
    skipped_files left = {0};
    for (size_t i = 0; i < f.count; i++)
        assert_int_equal(img_folder_skip(&f.at[i], "?", false, &left), OK);
    assert_int_equal(left.count, 1);
    assert_string_equal(left.at[0].name, "a.png~");
    assert_string_equal(left.at[0].why, "a copy");
    skipped_free(&left);
    img_folder_free(&f);
}

static void a_mask_lies_beside_its_photograph(void **state)
{
    (void)state;
    write_flat("cup.jpg", 4, 4, 3, 0.5f, IMG_SRGB8);
    write_flat("cup_alpha.png", 4, 4, 3, 0.5f, IMG_SRGB8);
    write_flat("dog_alpha.png", 4, 4, 3, 0.5f, IMG_SRGB8);
    assert_photo("cup.jpg", true);
    assert_photo("cup_alpha.png", false);
    assert_photo("dog_alpha.png", true);
    img_folder f;
    assert_int_equal(img_folder_read(scratch, &f), OK);
    assert_string_equal(img_folder_mask_of(&f, "cup.jpg", false)->name, "cup_alpha.png");
    assert_null(img_folder_mask_of(&f, "dog_alpha.png", false));
    img_folder_free(&f);
}

/* carnival-mask.jpg may be a photograph of one. */
static void a_name_alone_is_believed_where_the_picture_looks_like_a_mask(void **state)
{
    (void)state;
    write_halves("carnival-mask.png", true);
    assert_photo("carnival-mask.png", true);
    write_halves("carnival-mask.png", false);
    assert_photo("carnival-mask.png", false);
    write_halves("mask_01.png", true);
    assert_photo("mask_01.png", true);
    write_halves("carnival.mask.png", true); /* photographs do not have such names */
    assert_photo("carnival.mask.png", false);
}

static void the_folder_s_own_mask_goes_before_those_of_pictures(void **state)
{
    (void)state;
    static const char *const names[] = {"01_mask.png", "owl.mask.png", "mask.jpg", "mask.png"};
    write_flat("01.png", 4, 4, 3, 0.5f, IMG_SRGB8);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        write_halves(names[i], false);
        img_folder f;
        assert_int_equal(img_folder_read(scratch, &f), OK);
        assert_string_equal(img_folder_whole_mask(&f)->name, names[i]);
        img_folder_free(&f);
    }
}

static void a_camera_s_own_picture_is_known_beside_its_raw_one(void **state)
{
    (void)state;
    write_flat("one.NEF", 4, 4, 3, 0.5f, IMG_SRGB8);
    write_flat("One.jpg", 4, 4, 3, 0.5f, IMG_SRGB8);
    write_flat("two.jpg", 4, 4, 3, 0.5f, IMG_SRGB8);
    img_folder f;
    assert_int_equal(img_folder_read(scratch, &f), OK);
    assert_true(img_folder_is_beside_raw(&f, find(&f, "One.jpg")));
    assert_false(img_folder_is_beside_raw(&f, find(&f, "two.jpg")));
    assert_false(img_folder_is_beside_raw(&f, find(&f, "one.NEF")));
    img_folder_free(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        in_scratch(content_tells_what_a_picture_is),
        in_scratch(what_is_called_like_a_picture_but_is_damaged_counts_as_one),
        in_scratch(copies_and_what_systems_leave_are_no_photographs),
        in_scratch(a_mask_lies_beside_its_photograph),
        in_scratch(a_name_alone_is_believed_where_the_picture_looks_like_a_mask),
        in_scratch(the_folder_s_own_mask_goes_before_those_of_pictures),
        in_scratch(a_camera_s_own_picture_is_known_beside_its_raw_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
