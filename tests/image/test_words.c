/* SPDX-License-Identifier: MIT */
/* What pictures state about themselves: their curve, the page that is meant, and sizes beyond what is held in memory.
 */
#include <math.h>
#include <png.h>
#include <stdio.h>

#include "image/formats/picture_rows.h"
#include "image/read/read.h"

#include "writes.h"

enum { LONG = 4, SHORT = 3 };

typedef struct png_words {
    bool srgb;
    double gamma;
    const double *chromaticities;
    const uint8_t *cicp; /* four bytes of the cICP chunk */
} png_words;

/* Writes a line of grey or RGB codes of 16 bits, the same value in each channel. */
static void write_png16(const char *path, const uint16_t *codes, int width, int channels, const png_words *words)
{
    FILE *f = fopen(path, "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    assert_non_null(f);
    png_init_io(png, f);
    png_set_IHDR(png, info, (png_uint_32)width, 1, 16, channels == 1 ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (words->srgb) png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    if (words->gamma > 0) png_set_gAMA(png, info, words->gamma);
    const double *c = words->chromaticities;
    if (c) png_set_cHRM(png, info, c[6], c[7], c[0], c[1], c[2], c[3], c[4], c[5]);
    png_write_info(png, info);
    if (words->cicp) png_write_chunk(png, (png_const_bytep) "cICP", words->cicp, 4);
    uint8_t row[96];
    for (int i = 0; i < width * channels; i++) {
        row[2 * i] = (uint8_t)(codes[i] >> 8);
        row[2 * i + 1] = (uint8_t)codes[i];
    }
    png_write_row(png, row);
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    assert_int_equal(fclose(f), 0);
}

static float half_as(const png_words *words, int *bits)
{
    static const uint16_t half[1] = {32768};
    img samples;
    write_png16(scratch_path("half.png"), half, 1, 1, words);
    if (img_read_samples(scratch_path("half.png"), true, &samples, bits) != OK) fail_msg("%s", status_message());
    float value = samples.data[0];
    img_free(&samples);
    return value;
}

/* Reads the picture as a photograph, by img_read. */
static float photograph_half(void)
{
    img color;
    assert_int_equal(img_read(scratch_path("half.png"), &color, NULL), OK);
    float value = color.data[0];
    img_free(&color);
    return value;
}

static void sixteen_bits_are_decoded_by_the_curve_that_a_png_states(void **state)
{
    (void)state;
    static const uint8_t srgb[4] = {1, 13, 0, 1}, linear[4] = {1, 8, 0, 1}, bt709[4] = {1, 1, 0, 1};
    /* 32768 of 65535 by each curve's formula */
    const struct {
        png_words words;
        double light;
    } told[] = {
        {{.srgb = true}, 0.214048},  {{.gamma = 0.45455}, 0.214048},
        {{.gamma = 1}, 0.500008},    {{.gamma = 0.5}, 0.250008},
        {{.cicp = srgb}, 0.214048},  {{.cicp = linear}, 0.500008},
        {{.cicp = bt709}, 0.259597}, {{.cicp = linear, .srgb = true}, 0.500008},
    };
    for (size_t i = 0; i < sizeof told / sizeof *told; i++) {
        int bits;
        assert_float_equal(half_as(&told[i].words, &bits), told[i].light, 2e-6);
        assert_int_equal(bits, 16);
        assert_float_equal(photograph_half(), told[i].light, 2e-6); /* the same value */
    }
    int bits; /* without a statement: as a measurement, or as a photograph */
    assert_float_equal(half_as(&(png_words){0}, &bits), 0.500008, 1e-6);
    assert_float_equal(photograph_half(), 0.214048, 2e-6);
}

static void codes_of_bright_curves_are_light_with_a_unit(void **state)
{
    (void)state;
    static const uint8_t pq[4] = {1, 16, 0, 1}, hlg[4] = {1, 18, 0, 1};
    int bits;
    /* half of PQ's codes are 92.246 cd/m², where 203 is 1; half of HLG's are a twelfth of its light, where 0.26496 is 1
     */
    assert_float_equal(half_as(&(png_words){.cicp = pq}, &bits), 92.246 / 203, 2e-4);
    assert_int_equal(bits, 32);
    assert_float_equal(half_as(&(png_words){.cicp = hlg}, &bits), 1 / 12.0 / 0.26496, 2e-4);
    assert_int_equal(bits, 32);
}

static void codes_of_a_narrow_range_are_spread(void **state)
{
    (void)state;
    static const uint8_t narrow[4] = {1, 8, 0, 0};
    const uint16_t codes[3] = {16 << 8, 126 << 8, 235 << 8};
    img color;
    write_png16(scratch_path("narrow.png"), codes, 3, 1, &(png_words){.cicp = narrow});
    assert_int_equal(img_read(scratch_path("narrow.png"), &color, NULL), OK);
    assert_float_equal(color.data[0], 0, 1e-6);
    assert_float_equal(color.data[3], 110 / 219.0, 1e-6);
    assert_float_equal(color.data[6], 1, 1e-6);
    img_free(&color);
}

static void the_primaries_that_a_png_states_are_brought_to_srgb(void **state)
{
    (void)state;
    static const uint8_t bt2020[4] = {9, 8, 0, 1};
    static const double wide[8] = {0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290};
    const png_words words[] = {{.cicp = bt2020}, {.gamma = 1, .chromaticities = wide}};
    const uint16_t codes[6] = {13107, 6554, 6554, 32768, 32768, 32768}; /* 0.2 0.1 0.1, and grey */
    for (int i = 0; i < 2; i++) {
        img color;
        write_png16(scratch_path("wide.png"), codes, 2, 3, &words[i]);
        assert_int_equal(img_read(scratch_path("wide.png"), &color, NULL), OK);
        /* ITU-R BT.2087: red by 1.6605 -0.1246 -0.0182 of BT.2020's red; rows sum to 1 */
        assert_float_equal(color.data[0], 0.1 + 0.1 * 1.6605, 2e-4);
        assert_float_equal(color.data[1], 0.1 - 0.1 * 0.1246, 2e-4);
        assert_float_equal(color.data[2], 0.1 - 0.1 * 0.0182, 2e-4);
        for (int c = 3; c < 6; c++)
            assert_float_equal(color.data[c], 0.5, 2e-4);
        img_free(&color);
    }
}

static void an_unknown_curve_is_refused_by_its_numbers(void **state)
{
    (void)state;
    static const uint8_t unknown[4] = {1, 9, 0, 1}, chroma[4] = {1, 13, 1, 1};
    const uint16_t codes[1] = {7};
    img color;
    write_png16(scratch_path("odd.png"), codes, 1, 1, &(png_words){.cicp = unknown});
    assert_int_equal(img_read(scratch_path("odd.png"), &color, NULL), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "transfer 9"));
    write_png16(scratch_path("odd.png"), codes, 1, 1, &(png_words){.cicp = chroma});
    assert_int_equal(img_read(scratch_path("odd.png"), &color, NULL), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "matrix 1"));
}

typedef struct entry {
    uint16_t tag, type;
    uint32_t count, value;
} entry;

/* A page of 8 or 16 bits of grey, all of one code; kind: TIFF's NewSubfileType. */
typedef struct page {
    int width, height;
    uint16_t code;
    uint32_t kind;
    bool exif_srgb;
} page;

/* Writes pages whose entries are at known positions: pixels first, one page after the other. */
static void write_pages(const char *path, const page *pages, int count)
{
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    uint32_t at = 8, pixels[4], none = 0;
    for (int i = 0; i < count; i++) {
        pixels[i] = at;
        at += (uint32_t)(pages[i].width * pages[i].height) * 2;
    }
    fwrite("II*", 1, 4, f);
    fwrite(&at, 4, 1, f);
    for (int i = 0; i < count; i++)
        for (int k = 0; k < pages[i].width * pages[i].height; k++)
            fwrite(&pages[i].code, 2, 1, f);
    for (int i = 0; i < count; i++) {
        const page *p = &pages[i];
        uint32_t bytes = (uint32_t)(p->width * p->height) * 2;
        const uint16_t entries = 11, exif_entries = 1;
        uint32_t exif = at + 2 + entries * 12 + 4, behind = exif + 2 + 12 + 4;
        const entry list[] = {
            {254, LONG, 1, p->kind},
            {256, LONG, 1, (uint32_t)p->width},
            {257, LONG, 1, (uint32_t)p->height},
            {258, SHORT, 1, 16},
            {259, SHORT, 1, 1},
            {262, SHORT, 1, 1},
            {273, LONG, 1, pixels[i]},
            {277, SHORT, 1, 1},
            {278, LONG, 1, (uint32_t)p->height},
            {279, LONG, 1, bytes},
            {34665, LONG, 1, exif},
        };
        const entry space = {40961, SHORT, 1, p->exif_srgb ? 1 : 0xffff};
        fwrite(&entries, 2, 1, f);
        fwrite(list, sizeof *list, entries, f);
        fwrite(i + 1 < count ? &behind : &none, 4, 1, f);
        fwrite(&exif_entries, 2, 1, f);
        fwrite(&space, sizeof space, 1, f);
        fwrite(&none, 4, 1, f);
        at = behind;
    }
    assert_int_equal(fclose(f), 0);
}

static void the_large_page_of_a_tiff_is_the_picture(void **state)
{
    (void)state;
    static const page small_first[] = {{4, 3, 1000, 1, false}, {8, 6, 2000, 0, false}};
    static const page unsaid[] = {{4, 3, 1000, 0, false}, {8, 6, 2000, 0, false}, {2, 2, 3000, 0, false}};
    static const page with_mask[] = {{8, 6, 2000, 0, false}, {8, 6, 65535, 4, false}};
    const page *const all[] = {small_first, unsaid, with_mask};
    const int counts[] = {2, 3, 2};
    for (int i = 0; i < 3; i++) {
        img samples;
        int width, height, bits;
        write_pages(scratch_path("pages.tif"), all[i], counts[i]);
        assert_int_equal(img_read_size(scratch_path("pages.tif"), &width, &height), OK);
        assert_true(width == 8 && height == 6);
        if (img_read_samples(scratch_path("pages.tif"), true, &samples, &bits) != OK) fail_msg("%s", status_message());
        assert_true(samples.width == 8 && samples.height == 6);
        assert_float_equal(samples.data[0], 2000 / 65535.0, 1e-6);
        img_free(&samples);
    }
}

static void pages_of_one_size_are_refused_for_which_is_meant(void **state)
{
    (void)state;
    static const page two[] = {{8, 6, 1000, 0, false}, {8, 6, 2000, 0, false}};
    img color;
    write_pages(scratch_path("two.tif"), two, 2);
    assert_int_equal(img_read(scratch_path("two.tif"), &color, NULL), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "2 pages"));
}

static void a_tiff_of_16_bits_whose_exif_says_srgb_is_decoded(void **state)
{
    (void)state;
    for (int said = 0; said < 2; said++) {
        const page one = {8, 6, 32768, 0, said};
        img samples;
        int bits;
        write_pages(scratch_path("exif.tif"), &one, 1);
        assert_int_equal(img_read_samples(scratch_path("exif.tif"), true, &samples, &bits), OK);
        assert_float_equal(samples.data[0], said ? 0.214048 : 0.500008, 2e-6);
        img_free(&samples);
    }
}

/* Writes alternating black and white columns, 8 bits of grey. */
static void write_wide_png(const char *path, int width, int height)
{
    FILE *f = fopen(path, "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    uint8_t *row = malloc((size_t)width);
    assert_non_null(f);
    assert_non_null(row);
    png_init_io(png, f);
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_compression_level(png, 1);
    png_set_IHDR(png, info, (png_uint_32)width, (png_uint_32)height, 8, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_gAMA(png, info, 1);
    png_write_info(png, info);
    for (int x = 0; x < width; x++)
        row[x] = x % 2 ? 255 : x * 2 < width ? 51 : 0;
    for (int y = 0; y < height; y++)
        png_write_row(png, row);
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    free(row);
    assert_int_equal(fclose(f), 0);
}

static void what_is_too_large_is_read_at_a_reduced_size(void **state)
{
    (void)state;
    img color, mask;
    img_facts facts;
    int width, height;
    write_wide_png(scratch_path("wide.png"), 20001, 5);
    assert_int_equal(img_read_size(scratch_path("wide.png"), &width, &height), OK);
    assert_true(width == 10001 && height == 3);
    assert_int_equal(img_look(scratch_path("wide.png"), &facts), OK);
    assert_true(facts.reduced == 2 && facts.frames == 1);
    assert_int_equal(img_read(scratch_path("wide.png"), &color, NULL), OK);
    assert_true(color.width == 10001 && color.height == 3);
    /* the means of 0.2 and 1, of 0 and 1, and the last column alone; the last row is one row of the file */
    assert_float_equal(color.data[0], 0.6, 1e-6);
    assert_float_equal(img_at(&color, 8000, 2)[1], 0.5, 1e-6);
    assert_float_equal(img_at(&color, 10000, 1)[0], 0, 1e-6);
    img_free(&color);
    assert_int_equal(img_read_mask(scratch_path("wide.png"), &mask), OK);
    assert_true(mask.width == 10001 && mask.height == 3); /* as the photograph that it belongs to */
    img_free(&mask);
}

static void rows_too_long_to_hold_are_refused(void **state)
{
    (void)state;
    img color;
    write_wide_png(scratch_path("long.png"), 1000001, 1);
    assert_int_equal(img_read(scratch_path("long.png"), &color, NULL), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "1000001 x 1 pixels, more than 1000000 a side"));
    write_wide_png(scratch_path("long.png"), 1000000, 1);
    assert_int_equal(img_read(scratch_path("long.png"), &color, NULL), OK);
    img_free(&color);
}

/* Two pictures of one pixel, the first of colour 0 of a table of two, the other of colour 1. */
static void the_first_picture_of_an_animation_is_read(void **state)
{
    (void)state;
    static const uint8_t gif[] = "GIF89a\1\0\1\0\x80\0\0\xff\0\0\0\0\xff"
                                 "!\xf9\4\0\0\0\0\0,\0\0\0\0\1\0\1\0\0\2\2\x44\1\0"
                                 "!\xf9\4\0\0\0\0\0,\0\0\0\0\1\0\1\0\0\2\2\x4c\1\0;";
    assert_int_equal(file_write(scratch_path("two.gif"), gif, sizeof gif - 1), OK);
    img color;
    if (img_read(scratch_path("two.gif"), &color, NULL) != OK) fail_msg("%s", status_message());
    assert_true(color.width == 1 && color.height == 1 && color.data[0] == 1 && color.data[2] == 0);
    img_free(&color);
    img_facts facts;
    assert_int_equal(img_look(scratch_path("two.gif"), &facts), OK);
    assert_int_equal(facts.frames, 2);
}

/* EXR and raw pictures are decoded as a whole. */
static void what_was_decoded_as_a_whole_is_reduced_alike(void **state)
{
    (void)state;
    img wide, small;
    assert_int_equal(img_new(&wide, IMAGE_MAX_SIDE + 1, 3, 3), OK);
    assert_int_equal(img_new(&small, 3, 2, 1), OK);
    for (size_t i = 0; i < img_value_count(&wide); i++)
        wide.data[i] = (float)(i % 3) + (i / 3 % (IMAGE_MAX_SIDE + 1) % 2 ? 2 : 0);
    assert_int_equal(picture_reduce(&wide), OK);
    assert_int_equal(picture_reduce(&small), OK);
    assert_true(wide.width == IMAGE_MAX_SIDE / 2 + 1 && wide.height == 2 && small.width == 3);
    for (int c = 0; c < 3; c++) {
        assert_float_equal(img_at(&wide, 7, 1)[c], c + 1, 1e-6);
        assert_float_equal(img_at(&wide, IMAGE_MAX_SIDE / 2, 0)[c], c, 1e-6);
    }
    img_free(&wide);
    img_free(&small);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        in_scratch(sixteen_bits_are_decoded_by_the_curve_that_a_png_states),
        in_scratch(codes_of_bright_curves_are_light_with_a_unit),
        in_scratch(codes_of_a_narrow_range_are_spread),
        in_scratch(the_primaries_that_a_png_states_are_brought_to_srgb),
        in_scratch(an_unknown_curve_is_refused_by_its_numbers),
        in_scratch(the_large_page_of_a_tiff_is_the_picture),
        in_scratch(pages_of_one_size_are_refused_for_which_is_meant),
        in_scratch(a_tiff_of_16_bits_whose_exif_says_srgb_is_decoded),
        in_scratch(what_is_too_large_is_read_at_a_reduced_size),
        in_scratch(rows_too_long_to_hold_are_refused),
        in_scratch(the_first_picture_of_an_animation_is_read),
        in_scratch(what_was_decoded_as_a_whole_is_reduced_alike),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
