/* SPDX-License-Identifier: MIT */
/* netpbm's formats, BMP and TGA, written byte by byte by their specifications. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "image/color.h"
#include "image/read/read.h"

#include "writes.h"

/* Words of 8, 16 and 32 bits, little endian, that make a file. */
typedef struct bytes {
    size_t count;
    uint8_t at[4096];
} bytes;

static void put(bytes *b, size_t size, uint32_t value)
{
    for (size_t i = 0; i < size; i++)
        b->at[b->count++] = (uint8_t)(value >> (8 * i));
}

static void put_all(bytes *b, const void *data, size_t size)
{
    memcpy(b->at + b->count, data, size);
    b->count += size;
}

static const char *save(const bytes *b, const char *name)
{
    assert_int_equal(file_write(scratch_path(name), b->at, b->count), OK);
    return scratch_path(name);
}

/* Asserts that a picture has these 8-bit codes and, if not NULL, this alpha. */
static void assert_shows(const char *path, int width, int height, int channels, const uint8_t *codes,
                         const uint8_t *cover)
{
    img color = {0}, alpha = {0};
    status s = img_read(path, &color, &alpha);
    if (s != OK) print_error("%s\n", status_message());
    assert_int_equal(s, OK);
    assert_true(color.width == width && color.height == height && color.channels == 3);
    for (int i = 0; i < width * height; i++) {
        for (int c = 0; c < 3; c++) {
            float want = srgb_decode((float)codes[i * channels + (channels == 3 ? c : 0)] / 255.0f);
            assert_true(fabsf(color.data[3 * i + c] - want) < 1e-6f);
        }
        if (cover) assert_true(fabsf(alpha.data[i] - (float)cover[i] / 255.0f) < 1e-6f);
    }
    assert_true((cover != NULL) == (alpha.data != NULL));
    img_free(&color);
    img_free(&alpha);
    int w, h;
    assert_int_equal(img_read_size(path, &w, &h), OK);
    assert_true(w == width && h == height);
}

static void assert_refused(const char *path, const char *words)
{
    img color = {0};
    assert_int_equal(img_read(path, &color, NULL), MERLIN_BAD_INPUT);
    if (!strstr(status_message(), words)) print_error("%s\n", status_message());
    assert_non_null(strstr(status_message(), words));
    assert_null(color.data);
}

/* Asserts that a file with any byte missing at its end is refused. */
static void assert_needs_all(bytes b, const char *name)
{
    b.count--;
    assert_refused(save(&b, name), "cut short");
}

/* 3 x 2 pixels, all different. */
static const uint8_t six[18] = {250, 20, 30, 40, 250, 60, 70, 80, 250, 100, 110, 120, 130, 140, 150, 160, 170, 180};
static const uint8_t greys[6] = {0, 50, 100, 150, 200, 255};

/* ---- TGA ---- */

static bytes tga_head(int type, int width, int height, int bits, int descriptor)
{
    bytes b = {0};
    put(&b, 1, 3); /* bytes of a comment after the header */
    put(&b, 1, type % 8 == 1);
    put(&b, 1, (uint32_t)type);
    put(&b, 2, type % 8 == 1 ? 2 : 0); /* the colour map begins with index 2 */
    put(&b, 2, type % 8 == 1 ? 3 : 0);
    put(&b, 1, type % 8 == 1 ? 24 : 0);
    put(&b, 4, 0);
    put(&b, 2, (uint32_t)width);
    put(&b, 2, (uint32_t)height);
    put(&b, 1, (uint32_t)bits);
    put(&b, 1, (uint32_t)descriptor);
    put_all(&b, "abc", 3);
    return b;
}

static void put_bgr(bytes *b, const uint8_t rgb[3])
{
    for (int c = 2; c >= 0; c--)
        put(b, 1, rgb[c]);
}

static void a_tga_is_upright_by_its_descriptor(void **state)
{
    (void)state;
    for (int corner = 0; corner < 4; corner++) {
        bool from_right = corner & 1, from_top = corner & 2;
        bytes b = tga_head(2, 3, 2, 24, corner << 4);
        for (int y = 0; y < 2; y++)
            for (int x = 0; x < 3; x++)
                put_bgr(&b, six + 3 * ((from_top ? y : 1 - y) * 3 + (from_right ? 2 - x : x)));
        assert_shows(save(&b, "a.tga"), 3, 2, 3, six, NULL);
    }
}

static void runs_of_a_tga_reach_over_its_rows(void **state)
{
    (void)state;
    static const uint8_t shown[6] = {9, 7, 7, 7, 7, 8};
    bytes b = tga_head(11, 3, 2, 8, 0x20);
    put(&b, 2, 0x0900); /* one literal pixel */
    put(&b, 2, 0x0783); /* four equal pixels */
    put(&b, 2, 0x0800);
    assert_shows(save(&b, "a.tga"), 3, 2, 1, shown, NULL);
    assert_needs_all(b, "a.tga");
}

static void the_map_of_a_tga_begins_where_it_says(void **state)
{
    (void)state;
    bytes b = tga_head(1, 3, 1, 8, 0x20);
    for (int i = 0; i < 3; i++)
        put_bgr(&b, six + 3 * i);
    put(&b, 3, 0x040302);
    assert_shows(save(&b, "a.tga"), 3, 1, 3, six, NULL);
    b.at[b.count - 1] = 5;
    assert_refused(save(&b, "a.tga"), "damaged");
}

static void sixteen_bits_of_a_tga_are_five_a_colour(void **state)
{
    (void)state;
    static const uint8_t shown[6] = {255, 0, 132, 0, 255, 0}; /* 132 is 16 of 31 */
    bytes b = tga_head(2, 2, 1, 16, 0x20);
    put(&b, 2, 31 << 10 | 16);
    put(&b, 2, 31 << 5 | 0x8000); /* a bit that is not an attribute is ignored */
    assert_shows(save(&b, "a.tga"), 2, 1, 3, shown, NULL);
}

/* Appends the extension area: the kind of alpha, and the curve's exponent as a fraction. */
static void put_extension(bytes *b, int alpha, int over, int under)
{
    size_t at = b->count;
    put(b, 2, 495);
    while (b->count < at + 478)
        put(b, 1, 0);
    put(b, 2, (uint32_t)over);
    put(b, 2, (uint32_t)under);
    while (b->count < at + 494)
        put(b, 1, 0);
    put(b, 1, (uint32_t)alpha);
    put(b, 4, (uint32_t)at);
    put(b, 4, 0);
    put_all(b, "TRUEVISION-XFILE.", 18);
}

static void alpha_of_a_tga_is_what_it_is_said_to_be(void **state)
{
    (void)state;
    static const uint8_t cover[2] = {51, 255};
    enum { NONE = -1 };
    static const struct {
        int attributes, extension;
        bool shown;
    } cases[] = {{8, NONE, true}, {0, NONE, false}, {8, 0, false}, {8, 1, false}, {8, 2, false}, {0, 3, true}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        bytes b = tga_head(2, 2, 1, 32, 0x20 | cases[i].attributes);
        for (int x = 0; x < 2; x++) {
            put_bgr(&b, six + 3 * x);
            put(&b, 1, cover[x]);
        }
        if (cases[i].extension != NONE) put_extension(&b, cases[i].extension, 0, 0);
        assert_shows(save(&b, "a.tga"), 2, 1, 3, six, cases[i].shown ? cover : NULL);
    }
}

static void colours_that_a_tga_multiplied_are_divided(void **state)
{
    (void)state;
    static const uint8_t times[3] = {50, 4, 6}, shown[3] = {250, 20, 30}, cover[1] = {51};
    bytes b = tga_head(2, 1, 1, 32, 0x28);
    put_bgr(&b, times);
    put(&b, 1, cover[0]);
    put_extension(&b, 4, 0, 0);
    assert_shows(save(&b, "a.tga"), 1, 1, 3, shown, cover);
}

static void alpha_that_is_nothing_everywhere_is_left_out(void **state)
{
    (void)state;
    bytes b = tga_head(2, 1, 1, 32, 0x28);
    put_bgr(&b, six);
    put(&b, 1, 0);
    assert_shows(save(&b, "a.tga"), 1, 1, 3, six, NULL);
}

static void the_curve_that_a_tga_states_is_its_own(void **state)
{
    (void)state;
    bytes b = tga_head(3, 2, 1, 8, 0x20);
    put(&b, 2, 0x3380); /* 128 and 51 */
    put_extension(&b, 0, 1, 1);
    img color;
    assert_int_equal(img_read(save(&b, "a.tga"), &color, NULL), OK);
    assert_true(fabsf(color.data[0] - 128 / 255.0f) < 1e-6f && fabsf(color.data[3] - 0.2f) < 1e-6f);
    img_free(&color);
}

static void a_tga_shorter_than_its_claim_is_no_picture(void **state)
{
    (void)state;
    bytes b = tga_head(10, 65535, 65535, 8, 0);
    assert_refused(save(&b, "a.tga"), "not a picture");
}

/* ---- BMP ---- */

typedef struct bmp_words {
    int length, width, height, bits, packing, colours;
    const uint32_t *masks;
} bmp_words;

static bytes bmp_head(const bmp_words *w, const uint8_t *palette)
{
    bytes b = {0};
    put_all(&b, "BM\0\0\0\0\0\0\0\0\0\0\0\0", 14);
    put(&b, 4, (uint32_t)w->length);
    put(&b, w->length == 12 ? 2 : 4, (uint32_t)w->width);
    put(&b, w->length == 12 ? 2 : 4, (uint32_t)w->height);
    put(&b, 2, 1);
    put(&b, 2, (uint32_t)w->bits);
    if (w->length > 12) put(&b, 4, (uint32_t)w->packing);
    while (w->length > 12 && b.count < 46)
        put(&b, 1, 0);
    if (w->length > 12) put(&b, 4, (uint32_t)w->colours);
    if (w->length > 12) put(&b, 4, 0);
    for (int i = 0; w->masks && i < (w->length == 40 ? 3 : 4); i++)
        put(&b, 4, w->masks[i]);
    while (b.count < 14 + (size_t)w->length)
        put(&b, 1, 0);
    for (int i = 0; i < w->colours; i++) {
        put_bgr(&b, palette + 3 * i);
        if (w->length > 12) put(&b, 1, 0);
    }
    b.at[10] = (uint8_t)b.count;
    return b;
}

static void put_24_bits(bytes *b, bool from_top)
{
    for (int y = 0; y < 2; y++) {
        for (int x = 0; x < 3; x++)
            put_bgr(b, six + 3 * ((from_top ? y : 1 - y) * 3 + x));
        put(b, 3, 0);
    }
}

static void a_bmp_stands_on_its_last_row_unless_its_height_is_negative(void **state)
{
    (void)state;
    bytes b = bmp_head(&(bmp_words){40, 3, 2, 24, 0, 0, NULL}, NULL);
    put_24_bits(&b, false);
    assert_shows(save(&b, "a.bmp"), 3, 2, 3, six, NULL);
    b.count -= 3;
    assert_shows(save(&b, "a.bmp"), 3, 2, 3, six, NULL); /* without the padding of the last row */
    assert_needs_all(b, "a.bmp");
    b = bmp_head(&(bmp_words){124, 3, -2, 24, 0, 0, NULL}, NULL);
    put_24_bits(&b, true);
    assert_shows(save(&b, "a.bmp"), 3, 2, 3, six, NULL);
    b = bmp_head(&(bmp_words){12, 3, 2, 24, 0, 0, NULL}, NULL);
    put_24_bits(&b, false);
    assert_shows(save(&b, "a.bmp"), 3, 2, 3, six, NULL);
}

static void palettes_of_a_bmp_have_1_4_or_8_bits(void **state)
{
    (void)state;
    static const uint8_t two[9] = {100, 110, 120, 250, 20, 30, 100, 110, 120};
    static const struct {
        int bits;
        uint32_t row;
    } kinds[] = {{1, 0xa0}, {4, 0x1010}, {8, 0x010001}}; /* indices 1, 0, 1 */
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
        for (int length = 12; length <= 40; length += 28) {
            uint8_t shown[9];
            for (int i = 0; i < 3; i++)
                memcpy(shown + 3 * i, two + (i == 1 ? 0 : 3), 3);
            bytes b = bmp_head(&(bmp_words){length, 3, 1, kinds[k].bits, 0, 2, NULL}, two);
            put(&b, 4, kinds[k].row);
            assert_shows(save(&b, "a.bmp"), 3, 1, 3, shown, NULL);
        }
}

/* Indices 0 and 1 in 4 x 3 pixels, from below: two ones; nothing; a literal run from the second pixel on. */
static void runs_of_a_bmp_step_over_what_they_leave(void **state)
{
    (void)state;
    static const uint8_t two[6] = {0, 0, 0, 255, 255, 255}, shown[12] = {0, 255, 0, 255, 0, 0, 0, 0, 255, 255, 0, 0};
    static const uint8_t eight[] = {2, 1, 0, 0, 0, 2, 1, 1, 0, 3, 1, 0, 1, 0, 0, 1};
    bytes b = bmp_head(&(bmp_words){40, 4, 3, 8, 1, 2, NULL}, two);
    put_all(&b, eight, sizeof eight);
    assert_shows(save(&b, "a.bmp"), 4, 3, 1, shown, NULL);
    b.count -= 2;
    assert_refused(save(&b, "a.bmp"), "cut short");
    static const uint8_t four[] = {2, 0x11, 0, 2, 255, 1, 0, 0, 4, 0x01, 0, 1};
    static const uint8_t other[12] = {0, 255, 0, 255, 0, 0, 0, 0, 255, 255, 0, 0};
    b = bmp_head(&(bmp_words){40, 4, 3, 4, 2, 2, NULL}, two);
    put_all(&b, four, sizeof four);
    assert_shows(save(&b, "a.bmp"), 4, 3, 1, other, NULL);
}

static void masks_of_a_bmp_are_its_colours(void **state)
{
    (void)state;
    static const uint32_t masks[4] = {0xf800, 0x7e0, 0x1f, 0}, turned[4] = {0xff, 0xff00, 0xff0000, 0xff000000};
    static const uint8_t shown[6] = {255, 0, 132, 0, 255, 0}, cover[2] = {51, 255};
    bytes b = bmp_head(&(bmp_words){40, 2, 1, 16, 3, 0, masks}, NULL);
    b.at[10] = 66;
    put(&b, 4, (uint32_t)0x07e0 << 16 | 0xf800 | 16);
    assert_shows(save(&b, "a.bmp"), 2, 1, 3, shown, NULL);
    b = bmp_head(&(bmp_words){108, 2, 1, 32, 3, 0, turned}, NULL);
    for (int i = 0; i < 2; i++) {
        put_all(&b, six + 3 * i, 3);
        put(&b, 1, cover[i]);
    }
    assert_shows(save(&b, "a.bmp"), 2, 1, 3, six, cover);
    memset(b.at + 14 + 40 + 12, 0, 4); /* no alpha mask */
    assert_shows(save(&b, "a.bmp"), 2, 1, 3, six, NULL);
}

static void the_fourth_byte_of_a_bmp_without_masks_is_nothing(void **state)
{
    (void)state;
    bytes b = bmp_head(&(bmp_words){40, 1, 1, 32, 0, 0, NULL}, NULL);
    put_bgr(&b, six);
    put(&b, 1, 77);
    assert_shows(save(&b, "a.bmp"), 1, 1, 3, six, NULL);
}

static void bmps_that_are_not_read_are_refused(void **state)
{
    (void)state;
    bytes b = bmp_head(&(bmp_words){40, 1, 1, 24, 4, 0, NULL}, NULL);
    assert_refused(save(&b, "a.bmp"), "compression 4");
    b = bmp_head(&(bmp_words){40, 30000, 30000, 8, 1, 0, NULL}, NULL);
    assert_refused(save(&b, "a.bmp"), "30000 x 30000");
    b = bmp_head(&(bmp_words){40, 10000, 10000, 8, 1, 0, NULL}, NULL);
    assert_refused(save(&b, "a.bmp"), "cut short");
    b = bmp_head(&(bmp_words){40, 0, 1, 24, 0, 0, NULL}, NULL);
    assert_refused(save(&b, "a.bmp"), "no pixels");
}

/* ---- netpbm ---- */

static const char *save_text(const char *text, const void *data, size_t size)
{
    bytes b = {0};
    put_all(&b, text, strlen(text));
    if (size) put_all(&b, data, size);
    return save(&b, "a.pnm");
}

static void the_kinds_of_netpbm_show_the_same(void **state)
{
    (void)state;
    static const uint8_t bits[6] = {255, 0, 255, 0, 0, 255};
    assert_shows(save_text("P1\n3 2\n0 1 0\n110", NULL, 0), 3, 2, 1, bits, NULL);
    assert_shows(save_text("P4 3 2\n", "\x40\xc0", 2), 3, 2, 1, bits, NULL);
    assert_shows(save_text("P2\n# a remark\n3 2 255\n0 50 100\n150 200 255\n", NULL, 0), 3, 2, 1, greys, NULL);
    assert_shows(save_text("P5\n3 2\n255\n", greys, 6), 3, 2, 1, greys, NULL);
    assert_shows(save_text("P3 1 2 255 250 20 30 40 250 60", NULL, 0), 1, 2, 3, six, NULL);
    assert_shows(save_text("P6\n3 2 # wide\n255\n", six, 18), 3, 2, 3, six, NULL);
    assert_shows(save_text("P7\nWIDTH 3\nHEIGHT 2\nDEPTH 3\nMAXVAL 255\nTUPLTYPE RGB\nENDHDR\n", six, 18), 3, 2, 3, six,
                 NULL);
}

static void alpha_of_a_pam_is_its_last_sample(void **state)
{
    (void)state;
    static const uint8_t samples[4] = {100, 51, 200, 255}, shown[2] = {100, 200}, cover[2] = {51, 255};
    static const char head[] = "P7\nWIDTH 2\nHEIGHT 1\nDEPTH 2\nMAXVAL 255\nTUPLTYPE GRAYSCALE_ALPHA\nENDHDR\n";
    assert_shows(save_text(head, samples, 4), 2, 1, 1, shown, cover);
}

static void the_largest_sample_of_netpbm_is_1(void **state)
{
    (void)state;
    img color;
    int bits;
    assert_int_equal(img_read_samples(save_text("P5\n2 1\n1000\n", "\x01\xf4\x03\xe8", 4), false, &color, &bits), OK);
    assert_true(bits == 16 && fabsf(color.data[0] - 0.5f) < 1e-5f && color.data[1] == 1);
    img_free(&color);
    assert_refused(save_text("P5\n2 1\n100\n", "\x64\x65", 2), "damaged");
}

/* Rows run from the bottom, in either byte order. */
static void floats_of_netpbm_are_linear(void **state)
{
    (void)state;
    static const float rows[2] = {3, -0.25f};
    static const uint8_t swapped[8] = {0x40, 0x40, 0, 0, 0xbe, 0x80, 0, 0};
    for (int k = 0; k < 2; k++) {
        const char *path = k ? save_text("Pf\n1 2\n2.0\n", swapped, 8) : save_text("Pf\n1 2\n-1.0\n", rows, 8);
        float unit = k ? 2 : 1;
        img color;
        assert_int_equal(img_read(path, &color, NULL), OK);
        assert_true(color.data[0] == -0.25f * unit && color.data[3] == 3 * unit);
        img_free(&color);
    }
    static const uint8_t infinite[4] = {0, 0, 0x80, 0x7f};
    assert_refused(save_text("Pf\n1 1\n-1.0\n", infinite, 4), "not finite");
}

static void damaged_netpbm_is_refused(void **state)
{
    (void)state;
    assert_refused(save_text("P6\n3 2\n255\n", six, 17), "cut short");
    assert_refused(save_text("P2 2 1 255 7", NULL, 0), "cut short");
    assert_refused(save_text("P5 3 2 70000\n", six, 12), "damaged");
    assert_refused(save_text("P5 20000 20000 255\n", six, 18), "cut short");
    assert_refused(save_text("P5 999999999 999999999 255\n", six, 18), "pixels");
    assert_refused(save_text("P7\nWIDTH 1\nHEIGHT 1\nDEPTH 9\nMAXVAL 255\nENDHDR\n", six, 18), "damaged");
    assert_refused(save_text("P1 2 1 3 4", NULL, 0), "damaged");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        in_scratch(a_tga_is_upright_by_its_descriptor),
        in_scratch(runs_of_a_tga_reach_over_its_rows),
        in_scratch(the_map_of_a_tga_begins_where_it_says),
        in_scratch(sixteen_bits_of_a_tga_are_five_a_colour),
        in_scratch(alpha_of_a_tga_is_what_it_is_said_to_be),
        in_scratch(colours_that_a_tga_multiplied_are_divided),
        in_scratch(alpha_that_is_nothing_everywhere_is_left_out),
        in_scratch(the_curve_that_a_tga_states_is_its_own),
        in_scratch(a_tga_shorter_than_its_claim_is_no_picture),
        in_scratch(a_bmp_stands_on_its_last_row_unless_its_height_is_negative),
        in_scratch(palettes_of_a_bmp_have_1_4_or_8_bits),
        in_scratch(runs_of_a_bmp_step_over_what_they_leave),
        in_scratch(masks_of_a_bmp_are_its_colours),
        in_scratch(the_fourth_byte_of_a_bmp_without_masks_is_nothing),
        in_scratch(bmps_that_are_not_read_are_refused),
        in_scratch(the_kinds_of_netpbm_show_the_same),
        in_scratch(alpha_of_a_pam_is_its_last_sample),
        in_scratch(the_largest_sample_of_netpbm_is_1),
        in_scratch(floats_of_netpbm_are_linear),
        in_scratch(damaged_netpbm_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
