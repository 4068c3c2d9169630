/* SPDX-License-Identifier: MIT */
#include "image/read/read.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <vips/vips.h>

#include <cmocka.h>

#include "scratch.h"

/* This test is a program of its own, because libvips starts once a program: here the program starts it before the
 * library does. */
enum { SIDE = 16, THREADS = 3, KEPT = 70 };

static void write_grey(const char *path, double code)
{
    VipsImage *black = NULL, *grey = NULL, *codes = NULL;
    assert_int_equal(vips_black(&black, SIDE, SIDE, NULL), 0);
    assert_int_equal(vips_linear1(black, &grey, 1, code, NULL), 0);
    assert_int_equal(vips_cast_uchar(grey, &codes, NULL), 0);
    assert_int_equal(vips_jpegsave(codes, path, NULL), 0);
    g_object_unref(black);
    g_object_unref(grey);
    g_object_unref(codes);
}

static float read_grey(const char *path)
{
    img color;
    if (img_read(path, &color, NULL) != OK) fail_msg("%s", status_message());
    float value = color.data[0];
    img_free(&color);
    return value;
}

static void a_program_keeps_its_own_settings_of_libvips(void **state)
{
    (void)state;
    assert_int_equal(vips_init("test_vips_start"), 0);
    vips_concurrency_set(THREADS);
    vips_cache_set_max(KEPT);
    write_grey(scratch_path("grey.jpg"), 255);
    assert_true(read_grey(scratch_path("grey.jpg")) == 1);
    assert_int_equal(vips_concurrency_get(), THREADS);
    assert_int_equal(vips_cache_get_max(), KEPT);
    /* a cached picture is not used in place of a replaced file */
    write_grey(scratch_path("grey.jpg"), 0);
    assert_true(read_grey(scratch_path("grey.jpg")) == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {in_scratch(a_program_keeps_its_own_settings_of_libvips)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
