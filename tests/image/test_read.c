/* SPDX-License-Identifier: MIT */
#include "read_fixture.h"

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
    /* the table is the formula in double, rounded to float */
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
        /* away from the borders, where lossy formats smear; 0.06 is the error of their default quality here */
        assert_true(fabsf(img_at(&color, 2, 1)[0] - srgb_decode(250 / 255.0f)) < 0.06f);
        assert_true(fabsf(img_at(&color, 13, 6)[2] - srgb_decode(100 / 255.0f)) < 0.06f);
        assert_true(img_at(&color, 13, 1)[0] < 0.06f);
        img_free(&color);
    }
}

/* Interlaced, with a palette, and two greys of one bit each are decoded. */
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
        for (size_t i = 0; i < 3 * 16 * 8; i++) /* a palette's colours are found by clustering: one code of error */
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

/* Writes a line of three grey pixels; exif (NULL: none) follows them if it is late. */
/* A mask of one bit a pixel and a drawing with a palette, plain as they are, are packed a thousand times smaller, and
 * eight and four times as large again when they are read. */
static void plain_pngs_of_few_bits_are_not_taken_for_damaged(void **state)
{
    (void)state;
    enum { WIDTH = 6000, HEIGHT = 400 };
    img mask = {0};
    uint8_t *codes = calloc(WIDTH * HEIGHT, 1);
    assert_non_null(codes);
    memset(codes, 255, WIDTH * HEIGHT / 2);
    VipsImage *image = fixture(codes, WIDTH, HEIGHT, 1, VIPS_INTERPRETATION_B_W);
    for (int bits = 1; bits <= 8; bits *= 2)
        for (int palette = 0; palette < 2; palette++) {
            assert_int_equal(vips_pngsave(image, scratch_path("few.png"), "bitdepth", bits, "palette", palette,
                                          "compression", 9, NULL),
                             0);
            if (img_read_mask(scratch_path("few.png"), &mask) != OK) fail_msg("%d bits: %s", bits, status_message());
            assert_int_equal(mask.width, WIDTH);
            assert_true(mask.data[0] == 1 && mask.data[WIDTH * HEIGHT - 1] == 0);
            img_free(&mask);
        }
    g_object_unref(image);
    free(codes);
}

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
        /* its first column is seen at the bottom, and its gamma is applied, too */
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
    /* pure red of the wider P3 primaries is beyond sRGB's red and clips to it; its half bright red has another ratio
     * than the same codes without the profile */
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
    /* without the profile the P3 codes are a duller red */
    VipsImage *stripped = vips_image_new_from_file(scratch_path("p3.png"), NULL);
    assert_int_equal(vips_pngsave(stripped, scratch_path("stripped.png"), "strip", TRUE, NULL), 0);
    g_object_unref(stripped);
    assert_int_equal(img_read(scratch_path("stripped.png"), &untagged, NULL), OK);
    assert_true(untagged.data[0] < tagged.data[0] - 0.02f);
    img_free(&tagged);
    img_free(&untagged);
}

/* A measurement's 16 bits are linear; an editor's pictures state by their profile that they are not. */
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

static void one_pixel_is_a_picture(void **state)
{
    (void)state;
    uint8_t code[3] = {255, 0, 255};
    img color = {0};
    assert_int_equal(img_read(save(fixture(code, 1, 1, 3, VIPS_INTERPRETATION_sRGB), "one.png"), &color, NULL), OK);
    assert_true(color.width == 1 && color.height == 1 && color.data[0] == 1 && color.data[1] == 0);
    img_free(&color);
}

static void cielab_of_8_bits_is_colour(void **state)
{
    (void)state;
    img color = {0};
    assert_int_equal(img_read(save_quarters_in(VIPS_INTERPRETATION_LABQ, "lab.tif"), &color, NULL), OK);
    /* half a step of a* and b* is up to three codes of such saturated colours */
    assert_true(fabsf(srgb_encode(img_at(&color, 2, 1)[0]) - 250 / 255.0f) <= 3.01f / 255);
    assert_true(fabsf(srgb_encode(img_at(&color, 13, 6)[2]) - 100 / 255.0f) <= 3.01f / 255);
    img_free(&color);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_8_bit_code_becomes_its_linear_value_and_back),
        cmocka_unit_test(sixteen_bits_keep_their_steps),
        cmocka_unit_test(linear_png_round_trips_within_half_a_code),
        cmocka_unit_test(every_photograph_format_is_read),
        cmocka_unit_test(pngs_of_every_layout_show_the_same),
        cmocka_unit_test(plain_pngs_of_few_bits_are_not_taken_for_damaged),
        cmocka_unit_test(the_gamma_of_a_png_is_honoured),
        cmocka_unit_test(exif_orientation_turns_the_picture),
        cmocka_unit_test(a_png_is_turned_wherever_its_exif_stands),
        cmocka_unit_test(alpha_is_split_off_unchanged),
        cmocka_unit_test(colours_that_a_tiff_multiplied_by_alpha_are_divided_by_it),
        cmocka_unit_test(grey_with_alpha_becomes_colour_and_alpha),
        cmocka_unit_test(embedded_profile_is_honoured),
        cmocka_unit_test(samples_of_16_bits_mean_what_their_profile_says),
        cmocka_unit_test(radiance_files_are_linear),
        cmocka_unit_test(one_pixel_is_a_picture),
        cmocka_unit_test(cielab_of_8_bits_is_colour),
    };
    return cmocka_run_group_tests(tests, start, scratch_close);
}
