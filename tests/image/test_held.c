/* SPDX-License-Identifier: MIT */
/* Pictures that decoders hold as a whole: a few bytes that claim millions of pixels are refused before decoding. */
#include <stdio.h>
#include <string.h>

#include "image/read/read.h"
#include "scratch.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static const char *write_bytes(const char *name, const void *bytes, size_t size)
{
    const char *path = scratch_path(name);
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(bytes, 1, size, f), size);
    assert_int_equal(fclose(f), 0);
    return path;
}

static void expect_refusal(const char *path, const char *words)
{
    img color = {0}, alpha = {0};
    assert_int_equal(img_read(path, &color, &alpha), MERLIN_BAD_INPUT);
    if (!strstr(status_message(), words)) fail_msg("\"%s\" does not say \"%s\"", status_message(), words);
    assert_null(color.data);
}

/* The picture is lossless; its size minus one is in the first 28 bits. */
static void a_webp_of_too_many_pixels_is_refused_by_its_head(void **state)
{
    (void)state;
    const uint32_t size = 16382u | 16382u << 14;
    unsigned char file[] = "RIFF\x24\0\0\0WEBPVP8L\x18\0\0\0\x2f....................................";
    for (int i = 0; i < 4; i++)
        file[21 + i] = (unsigned char)(size >> 8 * i);
    expect_refusal(write_bytes("large.webp", file, 44), "held as a whole");
}

static const unsigned char frame[] = {0xff, 0xd8, 0xff, 0xc2, 0, 17,   8, 0x3e, 0x80, 0x3e, 0x80,
                                      3,    1,    0x22, 0,    2, 0x11, 0, 3,    0x11, 0};

static size_t jpeg_of(unsigned char kind, int components_in_scan, unsigned char to[64])
{
    size_t size = sizeof frame;
    memcpy(to, frame, size);
    to[3] = kind;
    const unsigned char scan[] = {0xff, 0xda, 0, (unsigned char)(6 + 2 * components_in_scan),
                                  (unsigned char)components_in_scan};
    memcpy(to + size, scan, sizeof scan);
    size += sizeof scan;
    for (int i = 0; i < components_in_scan; i++) {
        to[size++] = (unsigned char)(i + 1);
        to[size++] = 0;
    }
    to[size++] = 0;
    to[size++] = 63;
    to[size++] = 0;
    return size;
}

static void a_jpeg_in_scans_of_too_many_pixels_is_refused_by_its_head(void **state)
{
    (void)state;
    unsigned char file[64];
    expect_refusal(write_bytes("progressive.jpg", file, jpeg_of(0xc2, 3, file)), "held as a whole");
    expect_refusal(write_bytes("apart.jpg", file, jpeg_of(0xc0, 1, file)), "held as a whole");
}

/* A baseline JPEG is read row by row, whatever its size: this one is refused because it is truncated. */
static void a_jpeg_in_one_scan_is_not_refused_for_its_size(void **state)
{
    (void)state;
    unsigned char file[64];
    img color = {0}, alpha = {0};
    assert_int_equal(img_read(write_bytes("usual.jpg", file, jpeg_of(0xc0, 3, file)), &color, &alpha),
                     MERLIN_BAD_INPUT);
    assert_null(strstr(status_message(), "held as a whole"));
}

/* A PNG of two pixels has a text chunk that claims two billion bytes, for which libpng would allocate memory. */
static void a_png_whose_text_is_longer_than_the_file_is_refused(void **state)
{
    (void)state;
    static const unsigned char file[] = "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\2\0\0\0\2\b\2\0\0\0\xfd\xd4\x9as"
                                        "\x7e\0\0\1tEXta\0b....";
    expect_refusal(write_bytes("long.png", file, sizeof file - 1), "damaged or cut short");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_webp_of_too_many_pixels_is_refused_by_its_head),
        cmocka_unit_test(a_jpeg_in_scans_of_too_many_pixels_is_refused_by_its_head),
        cmocka_unit_test(a_png_whose_text_is_longer_than_the_file_is_refused),
        cmocka_unit_test(a_jpeg_in_one_scan_is_not_refused_for_its_size),
    };
    return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
