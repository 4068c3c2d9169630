/* SPDX-License-Identifier: MIT */
/* HEIC as in the command: libvips starts without its modules, and HEIF's is loaded when a picture needs it. The fixture
 * is written by a child process, because libvips must have its modules to write it. */
#include <math.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vips/vips.h>

#include "image/color.h"
#include "image/read/read.h"

#include "writes.h"

enum { SIDE = 64 };
static const double one[3] = {1, 1, 1}, sienna[3] = {180, 90, 60};

/* Writes a square in Display P3, as telephones' cameras do. */
static int write_square(const char *path)
{
    VipsImage *black = NULL, *plain = NULL, *codes = NULL, *srgb = NULL, *wide = NULL;
    return vips_init("test_heif") || !vips_type_find("VipsOperation", "heifsave") ||
           vips_black(&black, SIDE, SIDE, "bands", 3, NULL) || vips_linear(black, &plain, one, sienna, 3, NULL) ||
           vips_cast_uchar(plain, &codes, NULL) ||
           vips_copy(codes, &srgb, "interpretation", VIPS_INTERPRETATION_sRGB, NULL) ||
           vips_icc_transform(srgb, &wide, "p3", "input_profile", "srgb", NULL) ||
           vips_heifsave(wide, path, "Q", 90, NULL);
}

static void heic_and_its_profile_are_read_without_libvips_modules_at_the_start(void **state)
{
    (void)state;
    const char *path = scratch_path("square.heic");
    pid_t child = fork();
    if (child == 0) _exit(write_square(path));
    int outcome = -1;
    assert_int_equal(waitpid(child, &outcome, 0), child);
    if (outcome != 0) {
        print_message("this libvips writes no HEIC: not tested\n");
        skip();
    }
    (void)setenv("VIPSHOME", "/nonexistent", 0); /* as the commands have it */
    img color = {0};
    if (img_read(path, &color, NULL) != OK) fail_msg("%s", status_message());
    assert_int_equal(color.width, SIDE);
    /* read as sRGB the red would be 14 codes less; 3 are lost by rounding: to P3, to YCbCr, in the file, and back */
    for (int c = 0; c < 3; c++)
        assert_true(fabs(255 * srgb_encode(img_at(&color, SIDE / 2, SIDE / 2)[c]) - sienna[c]) <= 3);
    img_free(&color);
}

int main(void)
{
    const struct CMUnitTest tests[] = {in_scratch(heic_and_its_profile_are_read_without_libvips_modules_at_the_start)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
