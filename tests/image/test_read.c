/* SPDX-License-Identifier: MIT */
#include <OpenEXR/openexr.h>
#include <math.h>
#include <png.h>
#include <pthread.h>
#include <vips/vips.h>

#include "image/color.h"
#include "image/exr/exr.h"
#include "image/read/read.h"
#include "image/write/write.h"

#include "writes.h"

/* A libvips image of 8- or 16-bit codes, for fixtures. */
static VipsImage *fixture(const void *codes, int width, int height, int bands, VipsInterpretation interpretation)
{
    bool wide = interpretation == VIPS_INTERPRETATION_RGB16 || interpretation == VIPS_INTERPRETATION_GREY16;
    VipsImage *bare =
        vips_image_new_from_memory_copy(codes, (size_t)width * (size_t)height * (size_t)bands * (wide ? 2 : 1), width,
                                        height, bands, wide ? VIPS_FORMAT_USHORT : VIPS_FORMAT_UCHAR);
    VipsImage *out = NULL;
    assert_non_null(bare);
    assert_int_equal(vips_copy(bare, &out, "interpretation", interpretation, NULL), 0);
    g_object_unref(bare);
    return out;
}

/* Saves by the name's ending and drops the image. */
static const char *save(VipsImage *image, const char *name)
{
    const char *path = scratch_path(name);
    if (vips_image_write_to_file(image, path, NULL)) print_error("%s", vips_error_buffer());
    g_object_unref(image);
    assert_true(file_exists(path));
    return path;
}

static double exact(double encoded)
{
    return encoded <= 0.04045 ? encoded / 12.92 : pow((encoded + 0.055) / 1.055, 2.4);
}

static void every_8_bit_code_becomes_its_linear_value_and_back(void **state)
{
    (void)state;
    uint8_t codes[768];
    for (int i = 0; i < 768; i++)
        codes[i] = (uint8_t)(i / 3);
    img color = {0}, alpha = {0};
    assert_int_equal(img_read(save(fixture(codes, 16, 16, 3, VIPS_INTERPRETATION_sRGB), "a.png"), &color, &alpha), OK);
    assert_int_equal(color.width, 16);
    assert_int_equal(color.channels, 3);
    assert_null(alpha.data);
    /* the table is the double formula rounded to float */
    for (int i = 0; i < 768; i++)
        assert_true(color.data[i] == (float)exact(i / 3 / 255.0));
    assert_int_equal(img_write_png(scratch_path("b.png"), &color, IMG_SRGB8), OK);
    img again = {0};
    assert_int_equal(img_read(scratch_path("b.png"), &again, NULL), OK);
    assert_memory_equal(again.data, color.data, 768 * sizeof(float));
    img_free(&color);
    img_free(&again);
}

static void sixteen_bits_keep_their_steps(void **state)
{
    (void)state;
    uint16_t codes[16];
    for (int i = 0; i < 16; i++)
        codes[i] = (uint16_t)(1000 + i);
    img color = {0};
    const char *path = save(fixture(codes, 4, 4, 1, VIPS_INTERPRETATION_GREY16), "c.png");
    assert_int_equal(img_read(path, &color, NULL), OK);
    assert_int_equal(color.channels, 3);
    for (int i = 0; i < 48; i++)
        assert_true(color.data[i] == (float)exact((1000 + i / 3) / 65535.0));
    img_free(&color);
    path = save(fixture(codes, 4, 4, 1, VIPS_INTERPRETATION_GREY16), "c.tif");
    assert_int_equal(img_read(path, &color, NULL), OK);
    assert_true(color.data[47] == (float)exact(1015 / 65535.0));
    img_free(&color);
}

static void linear_png_round_trips_within_half_a_code(void **state)
{
    (void)state;
    static const struct {
        img_encoding encoding;
        float step;
    } kinds[] = {{IMG_LINEAR8, 1 / 255.0f}, {IMG_LINEAR16, 1 / 65535.0f}};
    img map, back;
    assert_int_equal(img_new(&map, 9, 7, 1), OK);
    for (int i = 0; i < 63; i++)
        map.data[i] = (float)i / 40 - 0.2f;
    for (int k = 0; k < 2; k++) {
        assert_int_equal(img_write_png(scratch_path("d.png"), &map, kinds[k].encoding), OK);
        assert_int_equal(img_read_mask(scratch_path("d.png"), &back), OK);
        assert_int_equal(back.channels, 1);
        for (int i = 0; i < 63; i++) {
            float expected = fminf(fmaxf(map.data[i], 0), 1);
            assert_true(fabsf(back.data[i] - expected) <= 0.5f * kinds[k].step + 1e-6f);
        }
        img_free(&back);
    }
    img_free(&map);
}

/* Left half red, right half blue, upper half bright: 16 × 8. */
static VipsImage *quarters(void)
{
    uint8_t codes[8][16][3] = {0};
    for (int y = 0; y < 8; y++)
        for (int x = 0; x < 16; x++)
            codes[y][x][x < 8 ? 0 : 2] = y < 4 ? 250 : 100;
    return fixture(codes, 16, 8, 3, VIPS_INTERPRETATION_sRGB);
}

static void every_photograph_format_is_read(void **state)
{
    (void)state;
    static const char *const names[] = {"q.png", "q.jpg", "q.tif", "q.webp", "q.gif", "q.heic"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        if (strstr(names[k], "heic") && !vips_type_find("VipsOperation", "heifsave")) {
            print_message("this libvips writes no HEIC: not tested\n");
            continue;
        }
        img color = {0};
        if (strstr(names[k], "heic")) {
            VipsImage *image = quarters();
            int failed = vips_heifsave(image, scratch_path(names[k]), "Q", 90, NULL);
            g_object_unref(image);
            if (failed) {
                print_message("HEIC cannot be written here (%s): not tested\n", vips_error_buffer());
                vips_error_clear();
                continue;
            }
        } else {
            save(quarters(), names[k]);
        }
        if (img_read(scratch_path(names[k]), &color, NULL) != OK) print_error("%s\n", status_message());
        assert_int_equal(color.width, 16);
        assert_int_equal(color.height, 8);
        int width, height;
        assert_int_equal(img_read_size(scratch_path(names[k]), &width, &height), OK);
        assert_true(width == 16 && height == 8);
        /* away from the borders, where lossy formats smear; 0.06 is what their default quality costs here */
        assert_true(fabsf(img_at(&color, 2, 1)[0] - srgb_decode(250 / 255.0f)) < 0.06f);
        assert_true(fabsf(img_at(&color, 13, 6)[2] - srgb_decode(100 / 255.0f)) < 0.06f);
        assert_true(img_at(&color, 13, 1)[0] < 0.06f);
        img_free(&color);
    }
}

/* Interlaced, by a palette, two greys a bit each: what a reader must unfold. */
static void pngs_of_every_layout_show_the_same(void **state)
{
    (void)state;
    img plain = {0}, color = {0};
    assert_int_equal(img_read(save(quarters(), "plain.png"), &plain, NULL), OK);
    for (int palette = 0; palette < 2; palette++) {
        VipsImage *image = quarters();
        int failed = vips_pngsave(image, scratch_path("laid.png"), "interlace", TRUE, "palette", palette, NULL);
        g_object_unref(image);
        assert_int_equal(failed, 0);
        assert_int_equal(img_read(scratch_path("laid.png"), &color, NULL), OK);
        for (size_t i = 0; i < 3 * 16 * 8; i++) /* a palette's colours are found by clustering: a code of error */
            assert_true(fabsf(color.data[i] - plain.data[i]) <= (palette ? 0.01f : 0));
        img_free(&color);
    }
    uint8_t codes[3] = {255, 0, 255};
    VipsImage *image = fixture(codes, 3, 1, 1, VIPS_INTERPRETATION_B_W);
    int failed = vips_pngsave(image, scratch_path("bits.png"), "bitdepth", 1, NULL);
    g_object_unref(image);
    assert_int_equal(failed, 0);
    assert_int_equal(img_read(scratch_path("bits.png"), &color, NULL), OK);
    assert_true(color.data[0] == 1 && color.data[4] == 0 && color.data[8] == 1);
    img_free(&color);
    img_free(&plain);
}

/* A line of three grey pixels; exif (NULL: none) stands behind them if it is late. */
static void write_png(const char *path, const uint8_t codes[3], double gamma, uint8_t exif[26], bool late)
{
    FILE *f = fopen(path, "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    assert_non_null(f);
    assert_non_null(info);
    png_init_io(png, f);
    png_set_IHDR(png, info, 3, 1, 8, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_set_gAMA(png, info, gamma);
    if (exif && !late) png_set_eXIf_1(png, info, 26, exif);
    png_write_info(png, info);
    png_write_row(png, codes);
    if (exif && late) png_set_eXIf_1(png, info, 26, exif);
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    assert_int_equal(fclose(f), 0);
}

static void the_gamma_of_a_png_is_honoured(void **state)
{
    (void)state;
    static const uint8_t codes[3] = {0, 51, 255}; /* 51 is 0.2 */
    static const struct {
        double gamma, light;
    } told[] = {{1, 0.2}, {1 / 1.8, 0.0551892}, {0.45455, 0.0331048}};
    for (int i = 0; i < 3; i++) {
        img color = {0}, mask = {0};
        write_png(scratch_path("gamma.png"), codes, told[i].gamma, NULL, false);
        assert_int_equal(img_read(scratch_path("gamma.png"), &color, NULL), OK);
        /* a file keeps five digits of its gamma: 5e-6 of 1 / 1.8 are 1.4e-6 of 0.2 to the 1.8th */
        assert_float_equal(color.data[3], told[i].light, 2e-6);
        assert_true(color.data[0] == 0 && color.data[6] == 1);
        assert_int_equal(img_read_mask(scratch_path("gamma.png"), &mask), OK);
        assert_float_equal(mask.data[1], 0.2, 1e-6);
        img_free(&color);
        img_free(&mask);
    }
}

static void a_png_is_turned_wherever_its_exif_stands(void **state)
{
    (void)state;
    static const uint8_t codes[3] = {0, 51, 255};
    uint8_t exif[26] = "II*\0\10\0\0\0\1\0\22\1\3\0\1\0\0\0\10"; /* one entry: orientation 8 */
    for (int late = 0; late < 2; late++) {
        img color = {0};
        write_png(scratch_path("turned.png"), codes, 1, exif, late);
        assert_int_equal(img_read(scratch_path("turned.png"), &color, NULL), OK);
        assert_int_equal(color.width, 1);
        assert_int_equal(color.height, 3);
        /* its first column is seen at the bottom, and its gamma is honoured, too */
        assert_true(color.data[0] == 1 && color.data[3] == 0.2f && color.data[6] == 0);
        img_free(&color);
    }
}

static void exif_orientation_turns_the_picture(void **state)
{
    (void)state;
    for (int orientation = 1; orientation <= 8; orientation++) {
        VipsImage *image = quarters();
        vips_image_set_int(image, VIPS_META_ORIENTATION, orientation);
        img color = {0};
        assert_int_equal(img_read(save(image, "turned.jpg"), &color, NULL), OK);
        bool sideways = orientation > 4;
        assert_int_equal(color.width, sideways ? 8 : 16);
        assert_int_equal(color.height, sideways ? 16 : 8);
        /* whether the file's row 0 is seen last (at the bottom, or at the right of a turned picture), and its column 0
         * (at the right, or at the bottom), by the EXIF standard's table */
        static const bool row_is_last[9] = {0, 0, 0, 1, 1, 0, 1, 1, 0};
        static const bool column_is_last[9] = {0, 0, 1, 1, 0, 0, 0, 1, 1};
        bool row_last = row_is_last[orientation], column_last = column_is_last[orientation];
        int along = row_last ? 6 : 1, across = column_last ? 14 : 1;
        const float *bright_red = sideways ? img_at(&color, along, across) : img_at(&color, across, along);
        assert_true(bright_red[0] > 0.8f && bright_red[2] < 0.1f);
        img_free(&color);
    }
}

static void alpha_is_split_off_unchanged(void **state)
{
    (void)state;
    uint8_t codes[4][4] = {{255, 0, 0, 0}, {0, 255, 0, 51}, {0, 0, 255, 128}, {255, 255, 255, 255}};
    img color = {0}, alpha = {0}, mask = {0};
    const char *path = save(fixture(codes, 2, 2, 4, VIPS_INTERPRETATION_sRGB), "alpha.png");
    assert_int_equal(img_read(path, &color, &alpha), OK);
    assert_int_equal(alpha.channels, 1);
    for (int i = 0; i < 4; i++)
        assert_true(alpha.data[i] == (float)codes[i][3] / 255);
    /* colour under a transparent pixel is kept */
    assert_true(color.data[0] == 1 && color.data[1] == 0);
    img_free(&color);
    assert_int_equal(img_read(path, &color, NULL), OK);
    assert_int_equal(img_read_mask(path, &mask), OK);
    assert_memory_equal(mask.data, alpha.data, 4 * sizeof(float));
    img_free(&color);
    img_free(&alpha);
    img_free(&mask);
}

enum { PHOTOMETRIC_RGB = 2, PHOTOMETRIC_YCBCR = 6 };

/* A TIFF of one line of two pixels, three colours and alpha in 32-bit floats; extra: what its alpha is. */
static void write_tiff(const char *path, const float pixels[8], uint16_t extra, uint16_t photometric)
{
    static const uint16_t LONG = 4, SHORT = 3;
    const struct {
        uint16_t tag, type;
        uint32_t count, value;
    } entries[] = {
        {256, LONG, 1, 2},  {257, LONG, 1, 1},  {258, SHORT, 4, 40}, {259, SHORT, 1, 1}, {262, SHORT, 1, photometric},
        {273, LONG, 1, 8},  {277, SHORT, 1, 4}, {278, LONG, 1, 1},   {279, LONG, 1, 32}, {338, SHORT, 1, extra},
        {339, SHORT, 4, 48}};
    static const uint16_t bits[4] = {32, 32, 32, 32}, floats[4] = {3, 3, 3, 3};
    const uint32_t folder = 56, none = 0;
    const uint16_t count = sizeof entries / sizeof *entries;
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    fwrite("II*", 1, 4, f);
    fwrite(&folder, 4, 1, f);
    fwrite(pixels, 4, 8, f);
    fwrite(bits, 2, 4, f);
    fwrite(floats, 2, 4, f);
    fwrite(&count, 2, 1, f);
    fwrite(entries, sizeof *entries, count, f);
    fwrite(&none, 4, 1, f);
    assert_int_equal(fclose(f), 0);
}

static void colours_that_a_tiff_multiplied_by_alpha_are_divided_by_it(void **state)
{
    (void)state;
    static const float stored[8] = {0.25f, 0.5f, 1.5f, 0.5f, 0.25f, 4, 1, 1};
    for (uint16_t extra = 1; extra <= 2; extra++) { /* associated, unassociated */
        img color = {0}, alpha = {0};
        float share = extra == 1 ? 0.5f : 1;
        write_tiff(scratch_path("floats.tif"), stored, extra, PHOTOMETRIC_RGB);
        assert_int_equal(img_read(scratch_path("floats.tif"), &color, &alpha), OK);
        for (int c = 0; c < 3; c++) {
            assert_float_equal(color.data[c], stored[c] / share, 1e-6);
            assert_float_equal(color.data[3 + c], stored[4 + c], 1e-6);
        }
        assert_non_null(alpha.data);
        assert_true(alpha.data[0] == 0.5f && alpha.data[1] == 1);
        img_free(&color);
        img_free(&alpha);
    }
}

static void grey_with_alpha_becomes_colour_and_alpha(void **state)
{
    (void)state;
    uint16_t codes[2][2] = {{65535, 0}, {0, 65535}};
    img color = {0}, alpha = {0};
    const char *path = save(fixture(codes, 2, 1, 2, VIPS_INTERPRETATION_GREY16), "ga.png");
    assert_int_equal(img_read(path, &color, &alpha), OK);
    assert_true(color.data[0] == 1 && color.data[2] == 1 && color.data[3] == 0);
    assert_true(alpha.data[0] == 0 && alpha.data[1] == 1);
    img_free(&color);
    img_free(&alpha);
}

static void embedded_profile_is_honoured(void **state)
{
    (void)state;
    /* pure red of the wider P3 primaries is beyond sRGB's red and clips to it; its half bright red keeps a ratio that
     * the same codes without the profile do not have */
    uint8_t codes[2][3] = {{200, 100, 100}, {128, 128, 128}};
    VipsImage *plain = fixture(codes, 2, 1, 3, VIPS_INTERPRETATION_sRGB), *p3 = NULL;
    img tagged = {0}, untagged = {0};
    int failed = vips_icc_transform(plain, &p3, "p3", "input_profile", "srgb", NULL);
    g_object_unref(plain);
    assert_int_equal(failed, 0);
    assert_int_equal(img_read(save(p3, "p3.png"), &tagged, NULL), OK);
    img_free(&untagged);
    /* there and back through 8-bit P3 codes: at most one code of error a channel */
    for (int c = 0; c < 3; c++) {
        assert_true(fabsf(srgb_encode(tagged.data[c]) * 255 - codes[0][c]) < 1.5f);
        assert_true(fabsf(srgb_encode(tagged.data[3 + c]) * 255 - codes[1][c]) < 1.5f);
    }
    /* without the profile the P3 codes mean a duller red */
    VipsImage *stripped = vips_image_new_from_file(scratch_path("p3.png"), NULL);
    assert_int_equal(vips_pngsave(stripped, scratch_path("stripped.png"), "strip", TRUE, NULL), 0);
    g_object_unref(stripped);
    assert_int_equal(img_read(scratch_path("stripped.png"), &untagged, NULL), OK);
    assert_true(untagged.data[0] < tagged.data[0] - 0.02f);
    img_free(&tagged);
    img_free(&untagged);
}

/* A measurement's 16 bits are linear; those that an editor developed say by their profile that they are not. */
static void samples_of_16_bits_mean_what_their_profile_says(void **state)
{
    (void)state;
    uint16_t codes[2][3] = {{40000, 20000, 10000}, {32768, 32768, 32768}};
    const char *const names[] = {"bare.png", "developed.png", "developed.tif"};
    for (int i = 0; i < 3; i++) {
        VipsImage *picture = fixture(codes, 2, 1, 3, VIPS_INTERPRETATION_RGB16), *developed = NULL;
        int failed = i ? vips_icc_transform(picture, &developed, "srgb", "input_profile", "srgb", "depth", 16, NULL)
                       : vips_copy(picture, &developed, NULL);
        g_object_unref(picture);
        assert_int_equal(failed, 0);
        const char *path = save(developed, names[i]);
        for (int decode = 0; decode < 2; decode++) {
            img samples;
            int bits;
            assert_int_equal(img_read_samples(path, decode, &samples, &bits), OK);
            assert_int_equal(bits, 16);
            for (int c = 0; c < 3; c++) {
                double value = codes[0][c] / 65535.0;
                /* to the profile's space and back, each in 16 bits and by tables */
                assert_float_equal(samples.data[c], i && decode ? exact(value) : value, 0.002);
            }
            img_free(&samples);
        }
    }
}

static void radiance_files_are_linear(void **state)
{
    (void)state;
    float light[12] = {0.5f, 1, 2, 0.25f, 0.25f, 0.25f, 100, 10, 1, 0, 0, 0};
    VipsImage *bare = vips_image_new_from_memory_copy(light, sizeof light, 2, 2, 3, VIPS_FORMAT_FLOAT), *named = NULL;
    assert_int_equal(vips_copy(bare, &named, "interpretation", VIPS_INTERPRETATION_scRGB, NULL), 0);
    g_object_unref(bare);
    img color = {0};
    assert_int_equal(img_read(save(named, "light.hdr"), &color, NULL), OK);
    /* a shared exponent leaves each channel 8 bits of the largest one */
    for (int i = 0; i < 12; i++) {
        float largest = fmaxf(light[i / 3 * 3], fmaxf(light[i / 3 * 3 + 1], light[i / 3 * 3 + 2]));
        assert_true(fabsf(color.data[i] - light[i]) <= largest / 128);
    }
    img_free(&color);
}

static void exr_pictures_are_found_by_their_channels(void **state)
{
    (void)state;
    img picture, color = {0}, alpha = {0};
    assert_int_equal(img_new(&picture, 5, 3, 3), OK);
    for (int i = 0; i < 45; i++)
        picture.data[i] = (float)i / 8;
    const exr_channel rgb[] = {
        {"R", picture.data, 3, false}, {"G", picture.data + 1, 3, false}, {"B", picture.data + 2, 3, false}};
    assert_int_equal(exr_write(scratch_path("rgb.exr"), 5, 3, rgb, 3, NULL, 0), OK);
    assert_int_equal(img_read(scratch_path("rgb.exr"), &color, &alpha), OK);
    assert_memory_equal(color.data, picture.data, 45 * sizeof(float));
    assert_null(alpha.data);
    img_free(&color);
    const exr_channel layer[] = {{"depth.Z", picture.data, 1, false},
                                 {"env.R", picture.data, 3, false},
                                 {"env.G", picture.data + 1, 3, false},
                                 {"env.B", picture.data + 2, 3, false}};
    assert_int_equal(exr_write(scratch_path("layer.exr"), 5, 3, layer, 4, NULL, 0), OK);
    assert_int_equal(img_read(scratch_path("layer.exr"), &color, &alpha), OK);
    assert_memory_equal(color.data, picture.data, 45 * sizeof(float));
    img_free(&color);
    const exr_channel own[] = {{"view.R", picture.data, 3, false},
                               {"view.G", picture.data + 1, 3, false},
                               {"view.B", picture.data + 2, 3, false},
                               {"view.A", picture.data, 1, false},
                               {"mask.A", picture.data + 1, 1, false}};
    assert_int_equal(exr_write(scratch_path("own.exr"), 5, 3, own, 5, NULL, 0), OK);
    assert_int_equal(img_read(scratch_path("own.exr"), &color, &alpha), OK);
    assert_non_null(alpha.data);
    assert_true(alpha.data[3] == picture.data[3]);
    for (int i = 0; i < 45; i++) /* as below */
        assert_true(color.data[i] == picture.data[i] / (i < 3 || i >= 24 ? 1 : picture.data[i / 3]));
    img_free(&color);
    img_free(&alpha);
    const exr_channel grey[] = {{"Y", picture.data, 1, false}, {"A", picture.data, 1, false}};
    assert_int_equal(exr_write(scratch_path("grey.exr"), 5, 3, grey, 2, NULL, 0), OK);
    assert_int_equal(img_read(scratch_path("grey.exr"), &color, &alpha), OK);
    assert_true(color.data[27] == picture.data[9] && color.data[29] == picture.data[9]);
    assert_true(alpha.data[3] == picture.data[3] && alpha.data[14] == 1);
    img_free(&color);
    img_free(&alpha);
    const exr_channel two[] = {{"R", picture.data, 1, false}, {"G", picture.data, 1, false}};
    assert_int_equal(exr_write(scratch_path("two.exr"), 5, 3, two, 2, NULL, 0), OK);
    assert_int_equal(img_read(scratch_path("two.exr"), &color, NULL), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "it has no channel B beside the others of R, G and B"));
    assert_int_equal(exr_write(scratch_path("depth.exr"), 5, 3, layer, 1, NULL, 0), OK);
    assert_int_equal(img_read(scratch_path("depth.exr"), &color, NULL), MERLIN_BAD_INPUT);
    img_free(&picture);
}

/* One line of floats, uncompressed. */
static void write_part(exr_context_t file, int part, int first_line, int channels, const float *line, int width)
{
    exr_encode_pipeline_t e = EXR_ENCODE_PIPELINE_INITIALIZER;
    exr_chunk_info_t chunk;
    assert_int_equal(exr_write_scanline_chunk_info(file, part, first_line, &chunk), 0);
    assert_int_equal(exr_encoding_initialize(file, part, &chunk, &e), 0);
    for (int i = 0; i < channels; i++) {
        e.channels[i].encode_from_ptr = (const uint8_t *)(line + i * width);
        e.channels[i].user_pixel_stride = 4;
        e.channels[i].user_line_stride = 4 * width;
    }
    assert_int_equal(exr_encoding_choose_default_routines(file, part, &e), 0);
    assert_int_equal(exr_encoding_run(file, part, &e), 0);
    exr_encoding_destroy(file, &e);
}

static void add_part(exr_context_t file, const char *name, const char *channels, int width)
{
    int part = 0;
    assert_int_equal(exr_add_part(file, name, EXR_STORAGE_SCANLINE, &part), 0);
    assert_int_equal(exr_initialize_required_attr_simple(file, part, width, 1, EXR_COMPRESSION_NONE), 0);
    for (; *channels; channels++) {
        const char channel[] = {*channels, 0};
        assert_int_equal(exr_add_channel(file, part, channel, EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LINEAR, 1, 1), 0);
    }
}

static exr_attr_box2i_t box(int left, int top, int right, int bottom)
{
    exr_attr_box2i_t b;
    b.min.x = left;
    b.min.y = top;
    b.max.x = right;
    b.max.y = bottom;
    return b;
}

/* Two pixels of R = 1 and G = 1 with the windows and chromaticities given (NULL: none). */
static void write_view(const char *name, const exr_attr_box2i_t *data, const exr_attr_box2i_t *display,
                       const exr_attr_chromaticities_t *primaries)
{
    static const float bgr[6] = {0, 0, 0, 1, 1, 0};
    exr_context_initializer_t quiet = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_context_t file;
    assert_int_equal(exr_start_write(&file, scratch_path(name), EXR_WRITE_FILE_DIRECTLY, &quiet), 0);
    add_part(file, "picture", "BGR", 2);
    assert_int_equal(exr_set_data_window(file, 0, data), 0);
    assert_int_equal(exr_set_display_window(file, 0, display), 0);
    if (primaries) assert_int_equal(exr_attr_set_chromaticities(file, 0, "chromaticities", primaries), 0);
    assert_int_equal(exr_write_header(file), 0);
    write_part(file, 0, data->min.y, 3, bgr, 2);
    assert_int_equal(exr_finish(&file), 0);
}

/* The numbers are those of ITU-R BT.2087 and of the usual ACEScg matrix (Bradford). */
static void the_chromaticities_of_an_exr_are_honoured(void **state)
{
    (void)state;
    const exr_attr_box2i_t window = box(0, 0, 1, 0);
    static const exr_attr_chromaticities_t rec2020 = {0.708f, 0.292f, 0.170f, 0.797f, 0.131f, 0.046f, 0.3127f, 0.3290f},
                                           acescg = {0.713f, 0.293f, 0.165f,   0.830f,
                                                     0.128f, 0.044f, 0.32168f, 0.33767f},
                                           none = {0};
    static const float wide[6] = {1.6605f, -0.1246f, -0.0182f, -0.5876f, 1.1329f, -0.1006f};
    static const float aces[6] = {1.70505f, -0.13026f, -0.02400f, -0.62179f, 1.14080f, -0.12897f};
    static const float same[6] = {1, 0, 0, 0, 1, 0};
    const exr_attr_chromaticities_t *primaries[] = {&rec2020, &acescg, NULL};
    const float *expected[] = {wide, aces, same};
    img color;
    int bits;
    for (int k = 0; k < 3; k++) {
        write_view("view.exr", &window, &window, primaries[k]);
        assert_int_equal(img_read(scratch_path("view.exr"), &color, NULL), OK);
        for (int i = 0; i < 6; i++)
            assert_float_equal(color.data[i], expected[k][i], 2e-4);
        img_free(&color);
    }
    write_view("view.exr", &window, &window, &acescg);
    assert_int_equal(img_read_samples(scratch_path("view.exr"), true, &color, &bits), OK);
    assert_memory_equal(color.data, same, sizeof same); /* a measurement stays what it is */
    img_free(&color);
    write_view("view.exr", &window, &window, &none);
    assert_int_equal(img_read(scratch_path("view.exr"), &color, NULL), MERLIN_BAD_INPUT);
}

/* As programs crop their pictures to what is not black, and render more than is to be seen. */
static void an_exr_is_what_its_display_window_shows(void **state)
{
    (void)state;
    const exr_attr_box2i_t data = box(3, -1, 4, -1);
    const exr_attr_box2i_t around = box(2, -2, 5, 0), part = box(4, -1, 4, -1), elsewhere = box(9, 9, 10, 9);
    img color;
    int width, height;
    write_view("around.exr", &data, &around, NULL);
    assert_int_equal(img_read_size(scratch_path("around.exr"), &width, &height), OK);
    assert_true(width == 4 && height == 3);
    assert_int_equal(img_read(scratch_path("around.exr"), &color, NULL), OK);
    for (int i = 0; i < 36; i++) /* red in the second, green in the third of the middle row */
        assert_true(color.data[i] == (i == 15 || i == 19));
    img_free(&color);
    write_view("part.exr", &data, &part, NULL);
    assert_int_equal(img_read(scratch_path("part.exr"), &color, NULL), OK);
    assert_true(color.width == 1 && color.height == 1 && color.data[0] == 0 && color.data[1] == 1);
    img_free(&color);
    write_view("elsewhere.exr", &data, &elsewhere, NULL);
    assert_int_equal(img_read(scratch_path("elsewhere.exr"), &color, NULL), OK);
    assert_true(color.width == 2 && color.height == 1 && color.data[0] == 0 && color.data[4] == 0);
    img_free(&color);
}

/* As renderers write them: a part a layer, sorted by whatever they sort them by. */
static void an_exr_is_its_first_part_that_is_a_picture(void **state)
{
    (void)state;
    static const float depth[3] = {7, 8, 9}, abgr[8] = {1, 0.25f, 3, 4, 5, 6, 7, 8};
    exr_context_initializer_t quiet = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_context_t file;
    img color = {0}, alpha = {0};
    int width, height;
    assert_int_equal(exr_start_write(&file, scratch_path("parts.exr"), EXR_WRITE_FILE_DIRECTLY, &quiet), 0);
    add_part(file, "depth", "Z", 3);
    add_part(file, "picture", "ABGR", 2);
    assert_int_equal(exr_write_header(file), 0);
    write_part(file, 0, 0, 1, depth, 3);
    write_part(file, 1, 0, 4, abgr, 2);
    assert_int_equal(exr_finish(&file), 0);
    assert_int_equal(img_read_size(scratch_path("parts.exr"), &width, &height), OK);
    assert_int_equal(width, 2);
    assert_int_equal(img_read(scratch_path("parts.exr"), &color, &alpha), OK);
    assert_true(color.data[0] == 7 && color.data[1] == 5 && color.data[2] == 3 && color.data[3] == 32);
    assert_non_null(alpha.data);
    assert_true(alpha.data[0] == 1 && alpha.data[1] == 0.25f);
    img_free(&color);
    img_free(&alpha);
}

/* As OpenEXR's convention wants it, and Blender writes it. */
static void colour_of_an_exr_is_not_times_its_alpha(void **state)
{
    (void)state;
    float rgba[16] = {2, 1, 0.5f, 1, 1, 0.5f, 0.25f, 0.5f, 0.5f, 0.25f, 0.125f, 0.25f, 3, 3, 3, 0};
    const float own[12] = {2, 1, 0.5f, 2, 1, 0.5f, 2, 1, 0.5f, 3, 3, 3};
    const exr_channel channels[] = {
        {"R", rgba, 4, false}, {"G", rgba + 1, 4, false}, {"B", rgba + 2, 4, false}, {"A", rgba + 3, 4, false}};
    img color = {0}, alpha = {0};
    assert_int_equal(exr_write(scratch_path("rgba.exr"), 4, 1, channels, 4, NULL, 0), OK);
    assert_int_equal(img_read(scratch_path("rgba.exr"), &color, &alpha), OK);
    assert_memory_equal(color.data, own, sizeof own);
    for (int i = 0; i < 4; i++)
        assert_true(alpha.data[i] == rgba[4 * i + 3]);
    img_free(&color);
    img_free(&alpha);
    /* who does not ask for alpha sees it over black */
    assert_int_equal(img_read(scratch_path("rgba.exr"), &color, NULL), OK);
    assert_true(color.data[3] == 1);
    img_free(&color);
}

/* As merlin estimate writes them. */
static void the_mask_of_maps_is_their_alpha(void **state)
{
    (void)state;
    float albedo[9] = {0.5f, 0.25f, 0.125f, 0.5f, 0.25f, 0.125f}, cover[3] = {1, 0.25f, 0};
    const exr_channel maps[] = {{"albedo.R", albedo, 3, false},
                                {"albedo.G", albedo + 1, 3, false},
                                {"albedo.B", albedo + 2, 3, false},
                                {"mask.A", cover, 1, false}};
    img color = {0}, alpha = {0}, mask = {0};
    assert_int_equal(exr_write(scratch_path("maps.exr"), 3, 1, maps, 4, NULL, 0), OK);
    assert_int_equal(img_read(scratch_path("maps.exr"), &color, &alpha), OK);
    assert_memory_equal(color.data, albedo, sizeof albedo);
    assert_int_equal(img_read_mask(scratch_path("maps.exr"), &mask), OK);
    assert_memory_equal(mask.data, cover, sizeof cover);
    assert_non_null(alpha.data);
    assert_memory_equal(alpha.data, cover, sizeof cover);
    img_free(&color);
    img_free(&alpha);
    img_free(&mask);
}

static void one_pixel_is_a_picture(void **state)
{
    (void)state;
    uint8_t code[3] = {255, 0, 255};
    img color = {0};
    assert_int_equal(img_read(save(fixture(code, 1, 1, 3, VIPS_INTERPRETATION_sRGB), "one.png"), &color, NULL), OK);
    assert_true(color.width == 1 && color.height == 1 && color.data[0] == 1 && color.data[1] == 0);
    img_free(&color);
}

/* Refused in one line that names the file and says the words. */
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

/* libvips keeps one for all. */
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
    /* a PNG of 20000 × 20000 (0x4e20) with a right header and no more */
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

static const char *save_quarters_in(VipsInterpretation space, const char *name)
{
    VipsImage *light = quarters(), *other = NULL;
    assert_int_equal(vips_colourspace(light, &other, space, NULL), 0);
    g_object_unref(light);
    return save(other, name);
}

/* Ink where others have light: read as it is, such a mask would choose what lies beside the object. */
static void masks_in_ink_are_refused(void **state)
{
    (void)state;
    const char *path = save_quarters_in(VIPS_INTERPRETATION_CMYK, "ink.tif");
    img mask, color;
    assert_int_equal(img_read_mask(path, &mask), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "ink.tif: its samples are cmyk"));
    assert_null(mask.data);
    assert_int_equal(img_read(path, &color, NULL), OK);
    img_free(&color);
}

static void cielab_of_8_bits_is_colour(void **state)
{
    (void)state;
    img color = {0};
    assert_int_equal(img_read(save_quarters_in(VIPS_INTERPRETATION_LABQ, "lab.tif"), &color, NULL), OK);
    /* half a step of a* and b* is up to three codes of so saturated colours */
    assert_true(fabsf(srgb_encode(img_at(&color, 2, 1)[0]) - 250 / 255.0f) <= 3.01f / 255);
    assert_true(fabsf(srgb_encode(img_at(&color, 13, 6)[2]) - 100 / 255.0f) <= 3.01f / 255);
    img_free(&color);
}

static int start(void **state)
{
    return VIPS_INIT("test") || scratch_open(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_8_bit_code_becomes_its_linear_value_and_back),
        cmocka_unit_test(sixteen_bits_keep_their_steps),
        cmocka_unit_test(linear_png_round_trips_within_half_a_code),
        cmocka_unit_test(every_photograph_format_is_read),
        cmocka_unit_test(pngs_of_every_layout_show_the_same),
        cmocka_unit_test(the_gamma_of_a_png_is_honoured),
        cmocka_unit_test(exif_orientation_turns_the_picture),
        cmocka_unit_test(a_png_is_turned_wherever_its_exif_stands),
        cmocka_unit_test(alpha_is_split_off_unchanged),
        cmocka_unit_test(colours_that_a_tiff_multiplied_by_alpha_are_divided_by_it),
        cmocka_unit_test(grey_with_alpha_becomes_colour_and_alpha),
        cmocka_unit_test(embedded_profile_is_honoured),
        cmocka_unit_test(samples_of_16_bits_mean_what_their_profile_says),
        cmocka_unit_test(radiance_files_are_linear),
        cmocka_unit_test(exr_pictures_are_found_by_their_channels),
        cmocka_unit_test(an_exr_is_its_first_part_that_is_a_picture),
        cmocka_unit_test(the_chromaticities_of_an_exr_are_honoured),
        cmocka_unit_test(an_exr_is_what_its_display_window_shows),
        cmocka_unit_test(colour_of_an_exr_is_not_times_its_alpha),
        cmocka_unit_test(the_mask_of_maps_is_their_alpha),
        cmocka_unit_test(one_pixel_is_a_picture),
        cmocka_unit_test(what_is_no_picture_is_refused),
        cmocka_unit_test(tiffs_of_luma_and_chroma_are_refused),
        cmocka_unit_test(radiance_files_of_other_colours_and_directions_are_refused),
        cmocka_unit_test(truncated_pictures_are_refused),
        cmocka_unit_test(every_thread_has_the_message_of_its_own_picture),
        cmocka_unit_test(huge_pictures_are_refused_by_their_header),
        cmocka_unit_test(what_is_not_finite_is_refused),
        cmocka_unit_test(masks_in_ink_are_refused),
        cmocka_unit_test(cielab_of_8_bits_is_colour),
    };
    return cmocka_run_group_tests(tests, start, scratch_close);
}
