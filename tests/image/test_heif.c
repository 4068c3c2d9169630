/* HEIC as the command reads it: libvips has started without its modules, and HEIF's is brought when a picture needs it.
 * The fixture is made by a child, because the libvips that writes it has its modules. */
#include <math.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vips/vips.h>

#include "image/read.h"
#include "image/start.h"
#include "image/write.h"

#include "writes.h"

enum { SIDE = 64, CODE = 180 };

static int write_grey_square(const char *path)
{
    VipsImage *black = NULL, *grey = NULL, *codes = NULL;
    return vips_init("test_heif") || !vips_type_find("VipsOperation", "heifsave") ||
           vips_black(&black, SIDE, SIDE, "bands", 3, NULL) || vips_linear1(black, &grey, 1, CODE, NULL) ||
           vips_cast_uchar(grey, &codes, NULL) || vips_heifsave(codes, path, "Q", 90, NULL);
}

static void heic_is_read_without_libvips_modules_at_the_start(void **state)
{
    (void)state;
    const char *path = scratch_path("grey.heic");
    pid_t child = fork();
    if (child == 0) _exit(write_grey_square(path));
    int outcome = -1;
    assert_int_equal(waitpid(child, &outcome, 0), child);
    if (outcome != 0) {
        print_message("this libvips writes no HEIC: not tested\n");
        skip();
    }
    vips_without_modules();
    img color = {0};
    if (img_read(path, &color, NULL) != OK) fail_msg("%s", status_message());
    assert_int_equal(color.width, SIDE);
    float code = 255 * srgb_encode(img_at(&color, SIDE / 2, SIDE / 2)[1]);
    assert_true(fabsf(code - CODE) <= 2); /* rounded on the way to YCbCr, by the quantization, and on the way back */
    img_free(&color);
}

int main(void)
{
    const struct CMUnitTest tests[] = {in_scratch(heic_is_read_without_libvips_modules_at_the_start)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
