/* SPDX-License-Identifier: MIT */
/* Raw pictures, which most cameras write as TIFF containers. */
#include <math.h>

#include "image/read/read.h"

#include "dng.h"
#include "writes.h"

enum { WIDTH = 96, HEIGHT = 64 };
static const float orange[3] = {0.6f, 0.3f, 0.1f};

static float plain(int x, int y, int channel)
{
    (void)x;
    (void)y;
    return orange[channel];
}

static float dim(int x, int y, int channel)
{
    return plain(x, y, channel) / 20;
}

static float left_half(int x, int y, int channel)
{
    (void)y;
    (void)channel;
    return x < WIDTH / 2 ? 0.5f : 0.125f;
}

static float too_bright(int x, int y, int channel)
{
    (void)x;
    (void)y;
    (void)channel;
    return 3;
}

static dng picture(float (*see)(int, int, int))
{
    return (dng){.width = WIDTH, .height = HEIGHT, .see = see, .neutral = {1, 1, 1}, .orientation = 1};
}

static void read_measured(const dng *d, img *out)
{
    int bits = 0;
    dng_write(scratch_path("a.dng"), d);
    if (img_read_samples(scratch_path("a.dng"), true, out, &bits) != OK) fail_msg("%s", status_message());
    assert_int_equal(bits, 16);
    assert_int_equal(out->channels, 3);
}

static void assert_colour(const img *image, int x, int y, const float color[3], float scale)
{
    for (int c = 0; c < 3; c++)
        if (fabsf(img_at(image, x, y)[c] - scale * color[c]) > 0.002f * scale)
            fail_msg("channel %d at %d %d is %g, not %g", c, x, y, (double)img_at(image, x, y)[c],
                     (double)(scale * color[c]));
}

static void what_the_sensor_saw_is_read_to_scale(void **state)
{
    (void)state;
    img image = {0};
    dng d = picture(plain);
    read_measured(&d, &image);
    assert_int_equal(image.width, WIDTH);
    assert_int_equal(image.height, HEIGHT);
    assert_colour(&image, 0, 0, orange, 1);
    assert_colour(&image, WIDTH / 2, HEIGHT / 2, orange, 1);
    img_free(&image);
    /* processing as a photograph would brighten it */
    d = picture(dim);
    read_measured(&d, &image);
    assert_colour(&image, WIDTH / 2, HEIGHT / 2, orange, 1 / 20.0f);
    img_free(&image);
    d = picture(too_bright);
    read_measured(&d, &image);
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        assert_true(image.data[i] == 1);
    img_free(&image);
}

static float too_green(int x, int y, int channel)
{
    (void)x;
    (void)y;
    return channel == 1 ? 2 : 0.25f;
}

static void what_saturates_in_one_colour_is_no_measurement(void **state)
{
    (void)state;
    const float green[3] = {0.25f, 1, 0.25f}, white[3] = {1, 1, 1};
    dng d = picture(too_green);
    img image = {0};
    read_measured(&d, &image);
    assert_colour(&image, WIDTH / 2, HEIGHT / 2, white, 1);
    img_free(&image);
    assert_int_equal(img_read(scratch_path("a.dng"), &image, NULL), OK);
    assert_colour(&image, WIDTH / 2, HEIGHT / 2, green, 1);
    img_free(&image);
}

/* A set's pictures keep their colours relative to each other, whatever their white balance. */
static void photographs_are_white_balanced_and_measurements_are_not(void **state)
{
    (void)state;
    const float balanced[3] = {orange[0] / 0.8f, orange[1], orange[2] / 0.5f};
    dng d = picture(plain);
    img image = {0};
    d.neutral[0] = 0.8f;
    d.neutral[2] = 0.5f;
    read_measured(&d, &image);
    assert_colour(&image, WIDTH / 2, HEIGHT / 2, orange, 1);
    img_free(&image);
    assert_int_equal(img_read(scratch_path("a.dng"), &image, NULL), OK);
    assert_colour(&image, WIDTH / 2, HEIGHT / 2, balanced, 1);
    img_free(&image);
}

static void a_camera_on_its_side_gives_an_upright_picture(void **state)
{
    (void)state;
    const float light[3] = {0.5f, 0.5f, 0.5f}, dark[3] = {0.125f, 0.125f, 0.125f};
    int width = 0, height = 0;
    img image = {0};
    dng d = picture(left_half);
    d.orientation = 6;
    read_measured(&d, &image);
    assert_int_equal(image.width, HEIGHT);
    assert_int_equal(image.height, WIDTH);
    assert_colour(&image, HEIGHT / 2, WIDTH / 4, light, 1);
    assert_colour(&image, HEIGHT / 2, WIDTH * 3 / 4, dark, 1);
    img_free(&image);
    assert_int_equal(img_read_size(scratch_path("a.dng"), &width, &height), OK);
    assert_true(width * height == WIDTH * HEIGHT && (width == WIDTH || width == HEIGHT));
}

static void a_preview_is_not_the_picture(void **state)
{
    (void)state;
    img image = {0};
    dng d = picture(plain);
    d.preview = true;
    for (int i = 0; i < 2; i++) {
        d.big_endian = i;
        read_measured(&d, &image);
        assert_int_equal(image.width, WIDTH);
        assert_colour(&image, WIDTH / 2, HEIGHT / 2, orange, 1);
        img_free(&image);
    }
}

static void read_float(const dng *d, img *out, bool photograph)
{
    int bits;
    dng_write(scratch_path("f.dng"), d);
    status s = photograph ? img_read(scratch_path("f.dng"), out, NULL)
                          : img_read_samples(scratch_path("f.dng"), true, out, &bits);
    if (s != OK) fail_msg("%s", status_message());
}

static float bright_half(int x, int y, int channel)
{
    (void)y;
    return (x < WIDTH / 2 ? 2.5f : 0.25f) * (channel == 1 ? 1 : 0.5f);
}

/* Three colours and a mosaic, each width, with and without the predictor, for white of 1 and of 4. */
static void raw_pictures_of_floats_are_light_beyond_white(void **state)
{
    (void)state;
    static const float bright[3] = {1.25f, 2.5f, 1.25f}, dark[3] = {0.125f, 0.25f, 0.125f};
    for (int k = 0; k < 24; k++) {
        dng d = picture(bright_half);
        d.floats = 16 + 8 * (k % 3);
        d.planes = k / 3 % 2;
        d.linear = k / 6 % 2;
        d.big_endian = k % 2;
        d.exceeds = k / 12 ? 4 : 0;
        dng_write(scratch_path("f.dng"), &d);
        img image = {0};
        int bits, width, height;
        if (img_read_samples(scratch_path("f.dng"), true, &image, &bits) != OK) fail_msg("%s", status_message());
        assert_true(bits == 32 && image.width == WIDTH && image.height == HEIGHT && image.channels == 3);
        assert_colour(&image, 0, 0, bright, 1);
        assert_colour(&image, WIDTH / 2 - 2, HEIGHT - 1, bright, 1);
        assert_colour(&image, WIDTH / 2 + 2, HEIGHT / 2, dark, 1);
        assert_colour(&image, WIDTH - 1, HEIGHT - 1, dark, 1);
        img_free(&image);
        assert_int_equal(img_read_size(scratch_path("f.dng"), &width, &height), OK);
        assert_true(width == WIDTH && height == HEIGHT);
    }
}

static void raw_pictures_of_floats_are_balanced_and_upright(void **state)
{
    (void)state;
    const float balanced[3] = {orange[0] / 0.8f, orange[1], orange[2] / 0.5f};
    dng d = picture(plain);
    img image = {0};
    d.floats = 32;
    d.linear = d.planes = true;
    d.orientation = 6;
    d.neutral[0] = 0.8f;
    d.neutral[2] = 0.5f;
    read_float(&d, &image, true);
    assert_true(image.width == HEIGHT && image.height == WIDTH);
    assert_colour(&image, 5, 5, balanced, 1);
    img_free(&image);
    read_float(&d, &image, false);
    assert_colour(&image, 5, 5, orange, 1);
    img_free(&image);
    assert_int_equal(truncate(scratch_path("f.dng"), 9000), 0);
    assert_int_equal(img_read(scratch_path("f.dng"), &image, NULL), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "damaged or cut short"));
}

static void cut(const char *name, off_t bytes)
{
    dng d = picture(plain);
    dng_write(scratch_path(name), &d);
    assert_int_equal(truncate(scratch_path(name), bytes), 0);
}

static void damaged_and_unknown_ones_are_refused_in_one_line(void **state)
{
    (void)state;
    img image = {0};
    cut("short.dng", 9000);
    assert_int_equal(img_read(scratch_path("short.dng"), &image, NULL), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "damaged or cut short"));
    assert_null(image.data);
    cut("head.dng", 600);
    assert_int_equal(img_read(scratch_path("head.dng"), &image, NULL), MERLIN_BAD_INPUT);
    FILE *f = fopen(scratch_path("b.orf"), "wb");
    assert_non_null(f);
    assert_true(fprintf(f, "IIRO%4096d", 0) == 4100 && fclose(f) == 0);
    assert_int_equal(img_read(scratch_path("b.orf"), &image, NULL), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "raw picture"));
    assert_null(strchr(status_message(), '\n'));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        in_scratch(what_the_sensor_saw_is_read_to_scale),
        in_scratch(what_saturates_in_one_colour_is_no_measurement),
        in_scratch(photographs_are_white_balanced_and_measurements_are_not),
        in_scratch(a_camera_on_its_side_gives_an_upright_picture),
        in_scratch(a_preview_is_not_the_picture),
        in_scratch(raw_pictures_of_floats_are_light_beyond_white),
        in_scratch(raw_pictures_of_floats_are_balanced_and_upright),
        in_scratch(damaged_and_unknown_ones_are_refused_in_one_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
