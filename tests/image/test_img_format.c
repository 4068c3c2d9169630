/* SPDX-License-Identifier: MIT */
/* Files are recognized by their content. */
#include "image/formats/img_format.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "base/file.h"
#include "image/write/write.h"

#include "scratch.h"
#include <cmocka.h> /* last, as cmocka defines a macro named fail */

static const char *put(const char *name, const void *data, size_t size)
{
    assert_int_equal(file_write(scratch_path(name), data, size), OK);
    return scratch_path(name);
}

static void assert_format(const char *path, const char *name, bool is_read)
{
    img_format f = img_format_of(path);
    assert_non_null(f.name);
    assert_string_equal(f.name, name);
    assert_int_equal(f.is_read, is_read);
    assert_int_equal(img_is_picture(path), is_read);
}

static void a_picture_is_known_whatever_it_is_called(void **state)
{
    (void)state;
    img one;
    assert_int_equal(img_new(&one, 1, 1, 3), OK);
    assert_int_equal(img_write_png(scratch_path("a.txt"), &one, IMG_SRGB8), OK);
    img_free(&one);
    assert_format(scratch_path("a.txt"), "PNG", true);
}

static void formats_that_are_not_read_have_names(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        size_t count;
        char bytes[40];
    } known[] = {
        {"JPEG 2000", 12, "\0\0\0\x0cjP  \r\n\x87\n"},
        {"JPEG XL", 12, "\0\0\0\x0cJXL \r\n\x87\n"},
        {"JPEG XL", 4, "\xff\x0a\x10\x10"},
        {"Photoshop", 6, "8BPS\0\1"},
        {"SVG", 38, "<?xml version=\"1.0\"?>\n<svg width=\"1\"/>"},
        {"PDF", 8, "%PDF-1.4"},
        {"Windows icon", 6, "\0\0\1\0\1\0"},
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        assert_format(put("a.png", known[i].bytes, known[i].count), known[i].name, false);
}

static void the_brands_of_a_still_picture_may_stand_behind_another(void **state)
{
    (void)state;
    static const char still[] = "\0\0\0\x18"
                                "ftypmiaf\0\0\0\0miafheic";
    static const char film[] = "\0\0\0\x18"
                               "ftypisom\0\0\0\0isommp42";
    assert_format(put("a", still, 24), "HEIC", true);
    assert_null(img_format_of(put("a", film, 24)).name);
}

/* The picture is 2 x 1 of three bytes, once complete and once without its last byte. */
static void a_tga_is_known_by_a_head_in_which_all_fits(void **state)
{
    (void)state;
    static const unsigned char tga[24] = {0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 1, 0, 24, 0, 1, 2, 3, 4, 5, 6};
    assert_string_equal(img_format_of(put("a", tga, 24)).name, "TGA");
    assert_null(img_format_of(put("a", tga, 23)).name);
    unsigned char other[24];
    memcpy(other, tga, 24);
    other[17] = 0xc0;
    assert_null(img_format_of(put("a", other, 24)).name);
}

static void text_and_folders_are_no_pictures(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "", "P", "P3", "P3 is the third point\n", "BMW\n", "1 0 0\n0 1 0\n", "<html></html>"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        assert_null(img_format_of(put("a.png", texts[i], strlen(texts[i]))).name);
    assert_false(img_is_picture("/tmp"));
    assert_false(img_is_picture("/dev/zero"));
    assert_false(img_is_picture(scratch_path("missing.png")));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_picture_is_known_whatever_it_is_called),
        cmocka_unit_test(formats_that_are_not_read_have_names),
        cmocka_unit_test(the_brands_of_a_still_picture_may_stand_behind_another),
        cmocka_unit_test(a_tga_is_known_by_a_head_in_which_all_fits),
        cmocka_unit_test(text_and_folders_are_no_pictures),
    };
    return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
