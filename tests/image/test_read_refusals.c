/* SPDX-License-Identifier: MIT */
/* Pictures that are refused, each with one line. */
#include "read_fixture.h"

/* Asserts that a picture is refused in one line that contains the file's name and the words. */
static void assert_refused(const char *path, const char *words)
{
    img color = {0}, alpha = {0}, mask = {0};
    assert_int_equal(img_read(path, &color, &alpha), MERLIN_BAD_INPUT);
    const char *name = strrchr(path, '/') + 1;
    if (!strstr(status_message(), name) || !strstr(status_message(), words) || strchr(status_message(), '\n'))
        print_error("message: %s\n", status_message());
    assert_non_null(strstr(status_message(), name));
    assert_non_null(strstr(status_message(), words));
    assert_null(strchr(status_message(), '\n'));
    assert_null(color.data);
    assert_null(alpha.data);
    assert_int_equal(img_read_mask(path, &mask), MERLIN_BAD_INPUT);
    assert_null(mask.data);
}

static void put(const char *name, const void *data, size_t size)
{
    assert_int_equal(file_write(scratch_path(name), data, size), OK);
}

static void what_is_no_picture_is_refused(void **state)
{
    (void)state;
    assert_refused(scratch_path("missing.png"), "No such file");
    assert_refused("/tmp/.", "folder");
    put("empty.png", "", 0);
    assert_refused(scratch_path("empty.png"), "empty");
    put("text.png", "these are words, not a picture\n", 31);
    assert_refused(scratch_path("text.png"), "not a picture");
    put("drawing.svg", "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"9\" height=\"9\"/>", 62);
    assert_refused(scratch_path("drawing.svg"), "SVG");
}

static void tiffs_of_luma_and_chroma_are_refused(void **state)
{
    (void)state;
    static const float pixels[8] = {0.5f, 0.5f, 0.5f, 1, 0.5f, 0.5f, 0.5f, 1};
    write_tiff(scratch_path("luma.tif"), pixels, 2, PHOTOMETRIC_YCBCR);
    assert_refused(scratch_path("luma.tif"), "YCbCr");
}

static void put_radiance(const char *format, const char *size)
{
    char file[256];
    int length = snprintf(file, sizeof file, "#?RADIANCE\nFORMAT=32-bit_rle_%s\n\n%s\n", format, size);
    memset(file + length, 0x80, 8);
    put("turned.hdr", file, (size_t)length + 8);
}

static void radiance_files_of_other_colours_and_directions_are_refused(void **state)
{
    (void)state;
    img color = {0};
    put_radiance("rgbe", "-Y 1 +X 2");
    assert_int_equal(img_read(scratch_path("turned.hdr"), &color, NULL), OK);
    assert_true(color.width == 2 && color.height == 1);
    img_free(&color);
    put_radiance("xyze", "-Y 1 +X 2");
    assert_refused(scratch_path("turned.hdr"), "XYZ");
    static const char *const turned[] = {"+Y 1 +X 2", "-Y 1 -X 2", "+Y 1 -X 2", "+X 2 -Y 1", "-X 2 +Y 1"};
    for (size_t i = 0; i < sizeof turned / sizeof *turned; i++) {
        put_radiance("rgbe", turned[i]);
        assert_refused(scratch_path("turned.hdr"), turned[i]);
    }
}

static void truncated_pictures_are_refused(void **state)
{
    (void)state;
    static const char *const names[] = {"cut.png", "cut.jpg", "cut.webp", "cut.tif", "cut.hdr"};
    enum { SIDE = 96 };
    static uint8_t noise[SIDE * SIDE * 3];
    srand(1);
    for (size_t i = 0; i < sizeof noise; i++)
        noise[i] = (uint8_t)rand();
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        const char *path = save(fixture(noise, SIDE, SIDE, 3, VIPS_INTERPRETATION_sRGB), names[k]);
        char *data = NULL;
        size_t size = 0;
        assert_int_equal(file_read(path, 1u << 22, &data, &size), OK);
        for (int part = 1; part < 4; part++) {
            put(names[k], data, size * (size_t)part / 4);
            assert_refused(path, strcmp(names[k], "cut.webp") == 0 ? "it is cut short, " : "cannot read");
        }
        free(data);
    }
}

enum { DAMAGED = 3 };
static struct {
    char path[256], words[256];
} damaged[DAMAGED];

static void *read_damaged_often(void *context)
{
    uintptr_t wrong = 0;
    (void)context;
    for (int i = 0; i < 900; i++) {
        img color = {0};
        wrong += img_read(damaged[i % DAMAGED].path, &color, NULL) != MERLIN_BAD_INPUT ||
                 strcmp(status_message(), damaged[i % DAMAGED].words) != 0;
        img_free(&color);
    }
    return (void *)wrong;
}

/* libvips keeps one message for all threads. */
static void every_thread_has_the_message_of_its_own_picture(void **state)
{
    (void)state;
    static const char *const names[DAMAGED] = {"own.jpg", "own.webp", "own.tif"};
    pthread_t others[3];
    for (int k = 0; k < DAMAGED; k++) {
        char *data = NULL;
        size_t size = 0;
        img color = {0};
        assert_int_equal(file_read(save(quarters(), names[k]), 1u << 20, &data, &size), OK);
        put(names[k], data, size / 3);
        free(data);
        snprintf(damaged[k].path, sizeof damaged[k].path, "%s", scratch_path(names[k]));
        assert_int_equal(img_read(damaged[k].path, &color, NULL), MERLIN_BAD_INPUT);
        snprintf(damaged[k].words, sizeof damaged[k].words, "%s", status_message());
    }
    for (int i = 0; i < 3; i++)
        assert_int_equal(pthread_create(&others[i], NULL, read_damaged_often, NULL), 0);
    uintptr_t wrong = (uintptr_t)read_damaged_often(NULL);
    for (int i = 0; i < 3; i++) {
        void *more;
        assert_int_equal(pthread_join(others[i], &more), 0);
        wrong += (uintptr_t)more;
    }
    assert_int_equal(wrong, 0);
}

static uint32_t crc32_of(const uint8_t *data, size_t size)
{
    uint32_t crc = 0xffffffffu;
    for (size_t i = 0; i < size; i++) {
        crc ^= data[i];
        for (int b = 0; b < 8; b++)
            crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
    }
    return ~crc;
}

static void huge_pictures_are_refused_by_their_header(void **state)
{
    (void)state;
    /* a PNG of 20000 × 20000 (0x4e20) with a valid header and nothing else */
    uint8_t head[45] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n', 0, 0,    0,    13, 'I',
                        'H',  'D', 'R', 0,   0,    0x4e, 0x20, 0,    0, 0x4e, 0x20, 8,  2};
    uint32_t crc = crc32_of(head + 12, 17);
    for (int i = 0; i < 4; i++)
        head[29 + i] = (uint8_t)(crc >> (24 - 8 * i));
    memcpy(head + 33, (uint8_t[]){0, 0, 0, 0, 'I', 'D', 'A', 'T', 0x35, 0xaf, 0x06, 0x1e}, 12);
    put("huge.png", head, sizeof head);
    assert_refused(scratch_path("huge.png"), "cut short");
    memcpy(head + 16, (uint8_t[]){0x7f, 0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff}, 8);
    crc = crc32_of(head + 12, 17);
    for (int i = 0; i < 4; i++)
        head[29 + i] = (uint8_t)(crc >> (24 - 8 * i));
    put("huge.png", head, sizeof head);
    assert_refused(scratch_path("huge.png"), "2147483647 x 2147483647");
    static float line[20000];
    const exr_channel channel = {"Y", line, 1, false};
    assert_int_equal(exr_write(scratch_path("wide.exr"), 20000, 1, &channel, 1, NULL, 0), OK);
    assert_refused(scratch_path("wide.exr"), "20000 x 1");
}

/* Found by fuzzing: the size in blocks overflowed. */
static void the_size_of_a_picture_may_be_the_largest_number(void **state)
{
    (void)state;
    const uint8_t head[54] = {'B',  'M',  54,   [10] = 54, [14] = 40, [18] = 0xff,
                              0xff, 0xff, 0x7f, 1,         [26] = 1,  [28] = 24};
    int width = 0, height = 0;
    put("wide.bmp", head, sizeof head);
    if (img_read_size(scratch_path("wide.bmp"), &width, &height) == OK) assert_true(width > 0 && height == 1);
    assert_true(width >= 0);
}

static void what_is_not_finite_is_refused(void **state)
{
    (void)state;
    float values[4] = {1, NAN, 2, 3};
    const exr_channel channel = {"Y", values, 1, false};
    assert_int_equal(exr_write(scratch_path("nan.exr"), 2, 2, &channel, 1, NULL, 0), OK);
    assert_refused(scratch_path("nan.exr"), "not finite");
    values[1] = INFINITY;
    VipsImage *bare = vips_image_new_from_memory_copy(values, sizeof values, 2, 2, 1, VIPS_FORMAT_FLOAT);
    assert_refused(save(bare, "inf.tif"), "not finite");
}

/* CMYK has ink where others have light, of which photometric stereo would make anything. */
static void measurements_in_ink_are_refused(void **state)
{
    (void)state;
    const char *path = save_quarters_in(VIPS_INTERPRETATION_CMYK, "ink.tif");
    img samples, color;
    int bits;
    assert_int_equal(img_read_samples(path, false, &samples, &bits), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "ink.tif: its samples are cmyk"));
    assert_null(samples.data);
    assert_int_equal(img_read(path, &color, NULL), OK);
    img_free(&color);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_no_picture_is_refused),
        cmocka_unit_test(tiffs_of_luma_and_chroma_are_refused),
        cmocka_unit_test(radiance_files_of_other_colours_and_directions_are_refused),
        cmocka_unit_test(truncated_pictures_are_refused),
        cmocka_unit_test(every_thread_has_the_message_of_its_own_picture),
        cmocka_unit_test(huge_pictures_are_refused_by_their_header),
        cmocka_unit_test(the_size_of_a_picture_may_be_the_largest_number),
        cmocka_unit_test(what_is_not_finite_is_refused),
        cmocka_unit_test(measurements_in_ink_are_refused),
    };
    return cmocka_run_group_tests(tests, start, scratch_close);
}
