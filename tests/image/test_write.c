/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <vips/vips.h>

#include "image/color.h"
#include "image/read/read.h"
#include "image/write/animation.h"
#include "image/write/figure.h"
#include "image/write/write.h"

#include "writes.h"

static img make(int width, int height, int channels)
{
    img image;
    assert_int_equal(img_new(&image, width, height, channels), OK);
    size_t count = (size_t)width * (size_t)height * (size_t)channels;
    for (size_t i = 0; i < count; i++)
        image.data[i] = (float)(i % 97) / 96;
    return image;
}

/* The row of noise is longer than the compressor's window, and the picture is filtered by several threads. */
static void rows_that_repeat_cost_next_to_nothing_in_a_png(void **state)
{
    (void)state;
    enum { WIDTH = 6000, HEIGHT = 40, ROW = 3 * WIDTH };
    img image, back = {0};
    assert_int_equal(img_new(&image, WIDTH, HEIGHT, 3), OK);
    uint32_t seed = 1;
    for (int i = 0; i < ROW; i++)
        image.data[i] = (float)((seed = seed * 1664525u + 1013904223u) >> 16) / 65535;
    for (int y = 1; y < HEIGHT; y++)
        memcpy(image.data + (size_t)y * ROW, image.data, ROW * sizeof *image.data);
    const char *path = scratch_path("rows.png");
    struct stat file;
    int bits = 0;
    assert_int_equal(img_write_png(path, &image, IMG_LINEAR16), OK);
    assert_int_equal(stat(path, &file), 0);
    assert_in_range(file.st_size, 2 * ROW, 2 * ROW + 2 * ROW / 10);
    assert_int_equal(img_read_samples(path, false, &back, &bits), OK);
    assert_int_equal(bits, 16);
    for (size_t i = 0; i < img_value_count(&image); i++)
        assert_true(fabsf(back.data[i] - image.data[i]) < 1e-6f);
    img_free(&image);
    img_free(&back);
}

static void srgb_formula_inverts_itself(void **state)
{
    (void)state;
    for (int i = 0; i <= 1000; i++) {
        float x = (float)i / 1000;
        /* powf is accurate to a few units in the last place, amplified at most 2.4-fold by the power */
        assert_true(fabsf(srgb_decode(srgb_encode(x)) - x) < 2e-6f);
    }
    assert_true(srgb_encode(0) == 0 && srgb_decode(0) == 0);
}

/* Codes of one value, of many at once, and the thresholds are tested. */
static void codes_are_the_nearest(void **state)
{
    (void)state;
    enum { VALUES = 200001 };
    float *values = malloc(VALUES * sizeof *values);
    uint8_t *codes = malloc(VALUES);
    for (int i = 0; i < VALUES; i++)
        values[i] = (float)i / (VALUES - 1);
    srgb_codes8(values, VALUES, codes);
    for (int i = 0; i < VALUES; i++) {
        assert_true(fabsf(srgb_encode(values[i]) * 255 - codes[i]) < 0.5f + 1e-4f);
        assert_int_equal(srgb_code8(values[i]), codes[i]);
    }
    for (int code = 1; code < 256; code++) {
        double encoded = (code - 0.5) / 255;
        float first = (float)(encoded <= 0.04045 ? encoded / 12.92 : pow((encoded + 0.055) / 1.055, 2.4));
        assert_int_equal(srgb_code8(first), code);
        assert_int_equal(srgb_code8(nextafterf(first, 0)), code - 1);
    }
    const float odd[] = {-1, -0.0f, NAN, -INFINITY, 1, 2, INFINITY};
    const uint8_t expected[] = {0, 0, 0, 0, 255, 255, 255};
    srgb_codes8(odd, sizeof expected, codes);
    assert_memory_equal(codes, expected, sizeof expected);
    free(values);
    free(codes);
}

/* Returns an integer of a file's header, as read by libvips. */
static int header(const char *path, const char *field)
{
    VipsImage *image = vips_image_new_from_file(path, "n", -1, NULL);
    int value = -1;
    assert_non_null(image);
    if (vips_image_get_int(image, field, &value)) value = -1;
    g_object_unref(image);
    return value;
}

/* Tells whether libpng finds a file of this encoding marked as sRGB. */
static bool says_srgb(img_encoding encoding)
{
    img image = make(5, 3, 3);
    const char *path = scratch_path("named.png");
    assert_int_equal(img_write_png(path, &image, encoding), OK);
    FILE *f = fopen(path, "rb");
    assert_non_null(f);
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, f);
    png_read_png(png, info, PNG_TRANSFORM_IDENTITY, NULL);
    int intent = -1;
    bool named = png_get_sRGB(png, info, &intent) == PNG_INFO_sRGB;
    assert_true(!named || intent == PNG_sRGB_INTENT_PERCEPTUAL);
    png_destroy_read_struct(&png, &info, NULL);
    fclose(f);
    img_free(&image);
    return named;
}

static void pictures_name_their_colour_space(void **state)
{
    (void)state;
    assert_true(says_srgb(IMG_SRGB8));
    assert_false(says_srgb(IMG_LINEAR8));
    assert_false(says_srgb(IMG_LINEAR16));
}

static void animations_loop_with_their_frames_and_delays(void **state)
{
    (void)state;
    static const char *const names[] = {"turn.webp", "turn.gif"};
    img_animation turn;
    assert_int_equal(img_animation_new(24, 16, 3, &turn), OK);
    assert_int_equal(img_animation_write(&turn, scratch_path("none.gif"), 80), MERLIN_WRONG_USE);
    img frame = make(24, 16, 3);
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 24 * 16 * 3; k++)
            frame.data[k] = k / 3 % 24 / 8 == i;
        assert_int_equal(img_animation_add(&turn, &frame), OK);
    }
    assert_int_equal(img_animation_add(&turn, &frame), MERLIN_WRONG_USE);
    for (int k = 0; k < 2; k++) {
        const char *path = scratch_path(names[k]);
        if (img_animation_write(&turn, path, 80) != OK) print_error("%s\n", status_message());
        assert_int_equal(header(path, "n-pages"), 3);
        assert_int_equal(header(path, "page-height"), 16);
        assert_int_equal(header(path, "width"), 24);
        assert_int_equal(header(path, "loop"), 0);
        VipsImage *image = vips_image_new_from_file(path, NULL);
        int *delays = NULL, count = 0;
        assert_int_equal(vips_image_get_array_int(image, "delay", &delays, &count), 0);
        assert_int_equal(count, 3);
        assert_int_equal(delays[1], 80);
        g_object_unref(image);
    }
    assert_int_equal(img_animation_write(&turn, scratch_path("turn.mp4"), 80), MERLIN_WRONG_USE);
    img_animation_free(&turn);
    img_free(&frame);
}

static void failed_writes_leave_nothing_and_say_where(void **state)
{
    (void)state;
    img image = make(4, 4, 3);
    const figure_tile tile = {"tile", &image};
    const char *path = scratch_path("no/such/place.png");
    assert_int_equal(img_write_png(path, &image, IMG_SRGB8), MERLIN_CANNOT_WRITE);
    assert_non_null(strstr(status_message(), "place.png"));
    assert_null(strchr(status_message(), '~'));
    img_animation still;
    assert_int_equal(img_animation_new(4, 4, 1, &still), OK);
    assert_int_equal(img_animation_add(&still, &image), OK);
    assert_int_equal(img_animation_write(&still, scratch_path("no/such/place.gif"), 80), MERLIN_CANNOT_WRITE);
    img_animation_free(&still);
    assert_int_equal(figure_sheet(path, &tile, 1, 1, 32), MERLIN_CANNOT_WRITE);
    /* a folder in the file's place */
    assert_int_equal(file_make_folder(scratch_path("taken.png")), OK);
    assert_int_equal(img_write_png(scratch_path("taken.png"), &image, IMG_SRGB8), MERLIN_CANNOT_WRITE);
    limit_file_size(32);
    status full = img_write_png(scratch_path("full.png"), &image, IMG_SRGB8);
    limit_file_size(0);
    assert_int_equal(full, MERLIN_CANNOT_WRITE);
    assert_non_null(strstr(status_message(), "full.png"));
    assert_false(file_exists(scratch_path("full.png")));
    assert_false(folder_has_leftovers());
    assert_int_equal(rmdir(scratch_path("taken.png")), 0);
    image.channels = 2;
    assert_int_equal(img_write_png(scratch_path("two.png"), &image, IMG_SRGB8), MERLIN_WRONG_USE);
    image.channels = 3;
    img_free(&image);
}

static void sheet_shows_its_tiles_where_they_belong(void **state)
{
    (void)state;
    enum { TILE = 96 };
    img wide = make(60, 30, 3), grey = make(20, 20, 1), sheet = {0};
    for (int i = 0; i < 60 * 30 * 3; i++)
        wide.data[i] = i % 3 == 0;
    for (int i = 0; i < 400; i++)
        grey.data[i] = 1;
    const figure_tile tiles[] = {{"wide <&> red", &wide}, {"grey", &grey}, {"w\xc3\xa4ide", &wide}};
    assert_int_equal(figure_sheet(scratch_path("sheet.png"), tiles, 3, 2, TILE), OK);
    assert_int_equal(img_read(scratch_path("sheet.png"), &sheet, NULL), OK);
    assert_true(sheet.width > 2 * TILE && sheet.width < 3 * TILE);
    assert_true(sheet.height > 2 * TILE && sheet.height < 4 * TILE);
    int red = 0, white = 0, ink = 0;
    for (int i = 0; i < sheet.width * sheet.height; i++) {
        const float *p = sheet.data + 3 * (size_t)i;
        red += p[0] == 1 && p[1] == 0 && p[2] == 0;
        white += p[0] == 1 && p[1] == 1 && p[2] == 1;
        ink += p[0] > 0.3f && p[0] < 0.9f && fabsf(p[0] - p[1]) < 0.1f;
    }
    /* two tiles of 2:1 fill half of a tile each */
    assert_int_equal(red, TILE * TILE);
    assert_int_equal(white, TILE * TILE);
    assert_true(ink > 50); /* three labels of at least four letters */
    img_free(&wide);
    img_free(&grey);
    img_free(&sheet);
}

static void chart_is_drawn_from_any_curves(void **state)
{
    (void)state;
    float x[200], falling[200], nothing[200];
    for (int i = 0; i < 200; i++) {
        x[i] = (float)i;
        falling[i] = i == 50 ? NAN : expf(-(float)i / 40);
        nothing[i] = -1;
    }
    const figure_curve curves[] = {{"falling", x, falling, 200}, {"never above zero", x, nothing, 200}};
    const figure_curve one = {"one point", x, falling, 1};
    img chart = {0};
    assert_int_equal(figure_chart(scratch_path("log.png"), "loss & more", "step", "loss", true, curves, 2), OK);
    assert_int_equal(figure_chart(scratch_path("linear.png"), "loss", "step", "loss", false, curves, 2), OK);
    assert_int_equal(figure_chart(scratch_path("point.png"), NULL, NULL, NULL, true, &one, 1), OK);
    assert_int_equal(figure_chart(scratch_path("empty.png"), "", "", "", false, NULL, 0), OK);
    assert_int_equal(img_read(scratch_path("log.png"), &chart, NULL), OK);
    assert_true(chart.width > 960);
    assert_int_equal(chart.height, 600);
    int blue = 0;
    for (int i = 0; i < chart.width * chart.height; i++)
        blue += chart.data[3 * i + 2] > chart.data[3 * i] + 0.3f;
    assert_true(blue > 800); /* a line across the plot, at least a pixel wide */
    img_free(&chart);
    assert_int_equal(img_read(scratch_path("empty.png"), &chart, NULL), OK);
    assert_int_equal(chart.width, 960);
    img_free(&chart);
}

/* A curve along the upper and right edge is not covered: in every row of the plot its last pixel is set. */
static void legend_covers_no_curve(void **state)
{
    (void)state;
    const float x[] = {0, 1, 1}, y[] = {1, 1, 0};
    const figure_curve curves[] = {{"along the edge", x, y, 3}, {"a longer name of a curve", x, y, 0}};
    img chart = {0};
    assert_int_equal(figure_chart(scratch_path("edge.png"), "edge", "x", "y", false, curves, 2), OK);
    assert_int_equal(img_read(scratch_path("edge.png"), &chart, NULL), OK);
    for (int row = 60; row < 525; row++) {
        const float *p = img_at(&chart, 931, row);
        assert_true(p[2] > p[0] + 0.1f);
    }
    img_free(&chart);
}

static void normals_and_depth_become_colours_inside_the_mask(void **state)
{
    (void)state;
    img normal = make(2, 1, 3), depth = make(2, 1, 1), mask = make(2, 1, 1), shown = {0};
    memcpy(normal.data, (float[6]){0, 0, 1, 1, 0, 0}, sizeof(float[6]));
    memcpy(depth.data, (float[2]){0.5f, INFINITY}, sizeof(float[2]));
    memcpy(mask.data, (float[2]){1, 0}, sizeof(float[2]));
    assert_int_equal(figure_normals(&normal, &mask, &shown), OK);
    assert_true(fabsf(srgb_encode(shown.data[0]) - 0.5f) < 1e-5f && fabsf(srgb_encode(shown.data[2]) - 1) < 1e-5f);
    assert_true(shown.data[3] == 0 && shown.data[5] == 0);
    img_free(&shown);
    assert_int_equal(figure_depth(&depth, &mask, &shown), OK);
    assert_true(shown.data[0] > 0 && isfinite(shown.data[0]) && shown.data[3] == 0);
    img_free(&shown);
    depth.data[1] = 0.7f;
    assert_int_equal(figure_depth(&depth, NULL, &shown), OK);
    assert_true(shown.data[0] > 0.99f && shown.data[3] < 0.05f && shown.data[3] > 0);
    img_free(&shown);
    assert_int_equal(figure_normals(&depth, NULL, &shown), MERLIN_WRONG_USE);
    img_free(&normal);
    img_free(&depth);
    img_free(&mask);
}

static int start(void **state)
{
    return VIPS_INIT("test") || scratch_open(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_that_repeat_cost_next_to_nothing_in_a_png),
        cmocka_unit_test(srgb_formula_inverts_itself),
        cmocka_unit_test(codes_are_the_nearest),
        cmocka_unit_test(pictures_name_their_colour_space),
        cmocka_unit_test(animations_loop_with_their_frames_and_delays),
        cmocka_unit_test(failed_writes_leave_nothing_and_say_where),
        cmocka_unit_test(sheet_shows_its_tiles_where_they_belong),
        cmocka_unit_test(chart_is_drawn_from_any_curves),
        cmocka_unit_test(legend_covers_no_curve),
        cmocka_unit_test(normals_and_depth_become_colours_inside_the_mask),
    };
    return cmocka_run_group_tests(tests, start, scratch_close);
}
