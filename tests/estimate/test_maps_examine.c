/* SPDX-License-Identifier: MIT */
/* maps.exr after others have had it: read rightly, refused by name, or mended with a word. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/vec.h"
#include "estimate/files/maps_files.h"
#include "estimate/surface/crop.h"
#include "flat.h"

enum { WIDTH = 48, HEIGHT = 40, PIXELS = WIDTH * HEIGHT, RADIUS = 15 };

/* Makes maps of a ball of radius RADIUS pixels in the middle. */
static merlin_maps ball(int width, int height)
{
    merlin_maps m = {.size = 256, .gain = 1, .mask_confidence = 1, .model = "none"};
    merlin_image *images[] = {&m.albedo, &m.normal, &m.roughness, &m.depth, &m.mask, &m.photo};
    const int channels[] = {3, 3, 1, 1, 1, 3};
    for (int i = 0; i < 6; i++) {
        img one;
        assert_int_equal(img_new(&one, width, height, channels[i]), OK);
        *images[i] = one;
    }
    for (int i = 0; i < width * height; i++) {
        float x = ((float)(i % width) + 0.5f - (float)width / 2) / RADIUS;
        float y = ((float)height / 2 - (float)(i / width) - 0.5f) / RADIUS, square = x * x + y * y;
        if (square >= 1) continue;
        vec3_put(vec3_make(0.25f, 0.5f, 0.75f), m.albedo.data + 3 * i);
        vec3_put(vec3_normalize(vec3_make(x, y, sqrtf(1 - square) + 0.1f)), m.normal.data + 3 * i);
        vec3_put(vec3_make(0.5f, 0.5f, 0.5f), m.photo.data + 3 * i);
        m.roughness.data[i] = 0.5f;
        m.depth.data[i] = 1 - 0.25f * sqrtf(1 - square);
        m.mask.data[i] = 1;
    }
    img mask = m.mask;
    crop_square c;
    assert_int_equal(crop_around(&mask, &c), OK);
    m.crop.x = c.x;
    m.crop.y = c.y;
    m.crop.side = c.side;
    return m;
}

static int object_pixels(const merlin_maps *m)
{
    int count = 0;
    for (int i = 0; i < m->mask.width * m->mask.height; i++)
        count += m->mask.data[i] > 0.5f;
    return count;
}

static void write_maps(const merlin_maps *m)
{
    assert_int_equal(maps_write_exr(m, scratch_path("maps.exr")), OK);
}

/* Writes maps, frees them, and reads them. */
static merlin_status again(merlin_maps *m, merlin_maps *out)
{
    write_maps(m);
    merlin_maps_free(m);
    return merlin_maps_read(scratch, out);
}

static void refused(merlin_maps m, const char *words)
{
    merlin_maps out;
    assert_int_equal(again(&m, &out), MERLIN_BAD_INPUT);
    if (!strstr(merlin_error(), words)) fail_msg("\"%s\" does not say \"%s\"", merlin_error(), words);
    assert_null(out.albedo.data);
}

/* Multiplies a map's values. */
static void scale(merlin_image *map, float by)
{
    for (int i = 0; i < PIXELS * map->channels; i++)
        map->data[i] *= by;
}

/* Writes into the file's head, from `skip` bytes behind the beginning of an attribute's name on. */
static void overwrite(const char *name, size_t skip, const void *with, size_t size)
{
    FILE *f = fopen(scratch_path("maps.exr"), "r+b");
    assert_non_null(f);
    char head[4096] = "";
    size_t length = fread(head, 1, sizeof head - 1, f), at = 0;
    while (at < length && strcmp(head + at, name) != 0)
        at++;
    assert_true(at + skip + size < length);
    assert_int_equal(fseek(f, (long)(at + skip), SEEK_SET), 0);
    assert_int_equal(fwrite(with, 1, size, f), size);
    assert_int_equal(fclose(f), 0);
}

/* Changes an attribute's value: its name, its type and its size stand before it. */
static void patch(const char *name, const char *type, const void *value, size_t size)
{
    overwrite(name, strlen(name) + strlen(type) + 6, value, size);
}

/* Gives an attribute another name of the same length. */
static void rename_attribute(const char *name, const char *to)
{
    overwrite(name, 0, to, strlen(to));
}

static void maps_come_back_without_a_word(void **state)
{
    (void)state;
    merlin_maps m = ball(WIDTH, HEIGHT), out;
    assert_int_equal(again(&m, &out), MERLIN_OK);
    assert_int_equal(out.doubts, 0);
    assert_true(out.mended.normal == 0 && out.mended.albedo == 0 && out.mended.depth == 0);
    assert_true(out.albedo.data[3 * (PIXELS / 2 + WIDTH / 2)] == 0.25f);
    merlin_maps_free(&out);
}

static void values_that_are_not_finite_are_refused_by_name_and_place(void **state)
{
    (void)state;
    static const char *const words[] = {"albedo.R is not finite in 2 pixels, the first at 24,20",
                                        "normal.X is not",
                                        "roughness.Y is not",
                                        "depth.Z is not",
                                        "mask.A is not",
                                        "photo.R is not"};
    for (int i = 0; i < 6; i++) {
        merlin_maps m = ball(WIDTH, HEIGHT);
        merlin_image *const images[] = {&m.albedo, &m.normal, &m.roughness, &m.depth, &m.mask, &m.photo};
        float *value = images[i]->data + (20 * WIDTH + 24) * images[i]->channels;
        value[0] = value[images[i]->channels] = NAN;
        refused(m, words[i]);
    }
}

static void beside_the_mask_nothing_matters(void **state)
{
    (void)state;
    merlin_maps m = ball(WIDTH, HEIGHT), out;
    m.albedo.data[0] = m.depth.data[0] = NAN;
    m.normal.data[0] = 7;
    assert_int_equal(again(&m, &out), MERLIN_OK);
    assert_int_equal(out.doubts, 0);
    assert_true(out.albedo.data[0] == 0 && out.depth.data[0] == 0 && out.normal.data[0] == 0);
    merlin_maps_free(&out);
}

static void long_normals_become_unit_and_that_is_said(void **state)
{
    (void)state;
    merlin_maps right = ball(WIDTH, HEIGHT), m = ball(WIDTH, HEIGHT), out;
    scale(&m.normal, 2);
    assert_int_equal(again(&m, &out), MERLIN_OK);
    assert_int_equal(out.doubts, MERLIN_DOUBT_NORMALS_NOT_UNIT);
    assert_string_equal(merlin_doubt_code(MERLIN_DOUBT_NORMALS_NOT_UNIT), "normals_not_unit");
    char text[256];
    merlin_doubt_message(&out, MERLIN_DOUBT_NORMALS_NOT_UNIT, text, sizeof text);
    assert_string_equal(text, "100 % of the normals are not of unit length, and were made so");
    for (int i = 0; i < 3 * PIXELS; i++)
        assert_float_equal(out.normal.data[i], right.normal.data[i], 1e-3); /* half's digits */
    merlin_maps_free(&out);
    merlin_maps_free(&right);
}

static void normals_that_are_none_are_refused(void **state)
{
    (void)state;
    merlin_maps m = ball(WIDTH, HEIGHT);
    for (int i = 0; i < 3 * PIXELS; i++)
        m.normal.data[i] = 0.5f * m.normal.data[i] + 0.5f;
    refused(m, "stored as colours");
    m = ball(WIDTH, HEIGHT);
    memset(m.normal.data + 3 * (20 * WIDTH + 24), 0, 6 * sizeof(float));
    refused(m, "no length in 2 of the object's");
    m = ball(WIDTH, HEIGHT);
    scale(&m.normal, -1);
    refused(m, "points away from the camera");
}

static void maps_in_another_unit_are_refused(void **state)
{
    (void)state;
    merlin_maps m = ball(WIDTH, HEIGHT);
    scale(&m.albedo, 255);
    refused(m, "albedo.R goes from 63.75 to 63.75, far out of range");
    m = ball(WIDTH, HEIGHT);
    scale(&m.depth, 1000);
    refused(m, "depth.Z goes from 7");
    m = ball(WIDTH, HEIGHT);
    scale(&m.depth, -1);
    refused(m, "depth.Z goes from -0.98");
    m = ball(WIDTH, HEIGHT);
    scale(&m.roughness, 5);
    refused(m, "roughness.Y goes from 2.5 to 2.5");
    m = ball(WIDTH, HEIGHT);
    scale(&m.mask, 255);
    refused(m, "mask.A goes from 0 to 255");
    m = ball(WIDTH, HEIGHT);
    scale(&m.mask, 0);
    refused(m, "its mask selects nothing");
}

static void a_few_values_out_of_range_are_clamped_and_counted(void **state)
{
    (void)state;
    const int pixel = 20 * WIDTH + 24;
    merlin_maps m = ball(WIDTH, HEIGHT), out;
    const float object = (float)object_pixels(&m);
    m.albedo.data[3 * pixel] = 3;
    m.albedo.data[3 * pixel + 3] = -3;
    m.roughness.data[pixel] = 0;
    m.depth.data[pixel] = 1000;
    assert_int_equal(again(&m, &out), MERLIN_OK);
    assert_int_equal(out.doubts,
                     MERLIN_DOUBT_ALBEDO_CLAMPED | MERLIN_DOUBT_ROUGHNESS_CLAMPED | MERLIN_DOUBT_DEPTH_CLAMPED);
    assert_float_equal(out.mended.albedo, 2 / object, 1e-6);
    assert_float_equal(out.mended.roughness, 1 / object, 1e-6);
    assert_float_equal(out.mended.depth, 1 / object, 1e-6);
    assert_true(out.albedo.data[3 * pixel] == 1 && out.albedo.data[3 * pixel + 3] == 0);
    merlin_maps_free(&out);
}

static void a_trimmed_data_window_is_read_at_its_place(void **state)
{
    (void)state;
    enum { LEFT = 12, TOP = 6 };
    merlin_maps m = ball(WIDTH, HEIGHT), out;
    m.crop.x += LEFT;
    m.crop.y += TOP;
    write_maps(&m);
    const int display[4] = {-LEFT, -TOP, WIDTH + 9, HEIGHT + 19};
    const float size[2] = {WIDTH + LEFT + 10, HEIGHT + TOP + 20};
    patch("displayWindow", "box2i", display, sizeof display);
    patch("merlinPicture", "floatvector", size, sizeof size);
    assert_int_equal(merlin_maps_read(scratch, &out), MERLIN_OK);
    assert_int_equal(out.albedo.width, WIDTH + LEFT + 10);
    assert_int_equal(out.depth.height, HEIGHT + TOP + 20);
    for (int y = 0; y < out.mask.height; y++)
        for (int x = 0; x < out.mask.width; x++) {
            bool inside = x >= LEFT && x < LEFT + WIDTH && y >= TOP && y < TOP + HEIGHT;
            float wanted = inside ? m.mask.data[(y - TOP) * WIDTH + x - LEFT] : 0;
            assert_true(out.mask.data[y * out.mask.width + x] == wanted);
            assert_true(out.albedo.data[3 * (y * out.mask.width + x)] == 0.25f * wanted);
        }
    merlin_maps_free(&m);
    merlin_maps_free(&out);
}

static void maps_of_another_size_than_was_written_are_refused(void **state)
{
    (void)state;
    merlin_maps m = ball(WIDTH, HEIGHT), out;
    write_maps(&m);
    merlin_maps_free(&m);
    const float half[2] = {WIDTH / 2, HEIGHT / 2};
    patch("merlinPicture", "floatvector", half, sizeof half);
    assert_int_equal(merlin_maps_read(scratch, &out), MERLIN_BAD_INPUT);
    assert_non_null(strstr(merlin_error(), "is 48 x 40 pixels now and was written with 24 x 20"));
}

static void a_crop_beside_the_object_is_refused(void **state)
{
    (void)state;
    merlin_maps m = ball(WIDTH, HEIGHT);
    m.crop.x = 500;
    refused(m, "not where its merlinCrop (500, ");
    /* of half the size, by a version that did not write it: another name hides it here */
    m = ball(WIDTH, HEIGHT);
    m.crop.side *= 2;
    write_maps(&m);
    merlin_maps_free(&m);
    merlin_maps out;
    assert_int_equal(merlin_maps_read(scratch, &out), MERLIN_OK); /* somebody has taken a part of the object away */
    merlin_maps_free(&out);
    rename_attribute("merlinPicture", "otherPicture");
    assert_int_equal(merlin_maps_read(scratch, &out), MERLIN_BAD_INPUT);
    assert_non_null(strstr(merlin_error(), "not where its merlinCrop"));
}

static void a_lens_or_a_crop_that_is_no_number_is_refused(void **state)
{
    (void)state;
    merlin_maps m = ball(WIDTH, HEIGHT);
    m.fov = NAN;
    refused(m, "its attribute merlinLens should be 3 finite numbers");
    m = ball(WIDTH, HEIGHT);
    m.fov = 170;
    refused(m, "no lens is as merlinLens says, 170 degrees wide");
    m = ball(WIDTH, HEIGHT);
    write_maps(&m);
    merlin_maps_free(&m);
    const float crop[3] = {NAN, 0, 40};
    patch("merlinCrop", "floatvector", crop, sizeof crop);
    merlin_maps out;
    assert_int_equal(merlin_maps_read(scratch, &out), MERLIN_BAD_INPUT);
    assert_non_null(strstr(merlin_error(), "merlinCrop should be 3 finite numbers"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        in_scratch(maps_come_back_without_a_word),
        in_scratch(values_that_are_not_finite_are_refused_by_name_and_place),
        in_scratch(beside_the_mask_nothing_matters),
        in_scratch(long_normals_become_unit_and_that_is_said),
        in_scratch(normals_that_are_none_are_refused),
        in_scratch(maps_in_another_unit_are_refused),
        in_scratch(a_few_values_out_of_range_are_clamped_and_counted),
        in_scratch(a_trimmed_data_window_is_read_at_its_place),
        in_scratch(maps_of_another_size_than_was_written_are_refused),
        in_scratch(a_crop_beside_the_object_is_refused),
        in_scratch(a_lens_or_a_crop_that_is_no_number_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
