/* SPDX-License-Identifier: MIT */
#include <vips/vips.h>

#include "image/exr/exr.h"
#include "image/read/read.h"

#include "writes.h"

enum { SIDE = 48, PIXELS = SIDE * SIDE, LEFT = 12, RIGHT = 28, TOP = 20, BOTTOM = 40 };

static bool is_object(int i)
{
    int x = i % SIDE, y = i / SIDE;
    return x >= LEFT && x < RIGHT && y >= TOP && y < BOTTOM;
}

/* Saves samples of 8 or 16 bits as a picture. */
static const char *save(const void *samples, int bands, VipsBandFormat format, const char *name)
{
    const char *path = scratch_path(name);
    size_t size = (size_t)PIXELS * (size_t)bands * (format == VIPS_FORMAT_USHORT ? 2 : 1);
    VipsImage *image = vips_image_new_from_memory_copy(samples, size, SIDE, SIDE, bands, format);
    VipsInterpretation space = format == VIPS_FORMAT_USHORT ? VIPS_INTERPRETATION_GREY16
                               : bands > 2                  ? VIPS_INTERPRETATION_sRGB
                                                            : VIPS_INTERPRETATION_B_W;
    VipsImage *meant = NULL;
    assert_non_null(image);
    assert_int_equal(vips_copy(image, &meant, "interpretation", space, NULL), 0);
    assert_int_equal(vips_image_write_to_file(meant, path, NULL), 0);
    g_object_unref(meant);
    g_object_unref(image);
    return path;
}

static const char *save_grey(const uint8_t codes[PIXELS], const char *name)
{
    return save(codes, 1, VIPS_FORMAT_UCHAR, name);
}

static void fill(uint8_t outside, uint8_t inside, uint8_t codes[PIXELS])
{
    for (int i = 0; i < PIXELS; i++)
        codes[i] = is_object(i) ? inside : outside;
}

/* Asserts that the mask is at least one half on the object and nowhere else; sharply: 1 and 0. */
static void assert_selects_object(const char *path, bool sharply)
{
    img mask;
    status s = img_read_mask(path, &mask);
    if (s != OK) print_error("%s\n", status_message());
    assert_int_equal(s, OK);
    assert_true(mask.width == SIDE && mask.height == SIDE && mask.channels == 1);
    for (int i = 0; i < PIXELS; i++) {
        assert_int_equal(mask.data[i] >= 0.5f, is_object(i));
        if (sharply) assert_true(mask.data[i] == (is_object(i) ? 1.0f : 0.0f));
    }
    img_free(&mask);
}

static void assert_refused(const char *path, const char *words)
{
    img mask;
    assert_int_equal(img_read_mask(path, &mask), MERLIN_BAD_INPUT);
    if (!strstr(status_message(), words)) print_error("%s\n", status_message());
    assert_non_null(strstr(status_message(), words));
    assert_non_null(strstr(status_message(), path));
    assert_null(mask.data);
}

static void two_values_are_a_mask_whatever_they_are(void **state)
{
    (void)state;
    static const uint8_t pairs[][2] = {{0, 255}, {0, 1}, {0, 15}, {1, 2}, {254, 255}, {200, 250}, {0, 127}, {100, 128}};
    uint8_t codes[PIXELS];
    for (size_t k = 0; k < sizeof pairs / sizeof *pairs; k++) {
        fill(pairs[k][0], pairs[k][1], codes);
        assert_selects_object(save_grey(codes, "two.png"), true);
        assert_selects_object(save_grey(codes, "two.tif"), true);
    }
    uint16_t wide[PIXELS];
    for (int i = 0; i < PIXELS; i++)
        wide[i] = is_object(i) ? 1 : 0;
    assert_selects_object(save(wide, 1, VIPS_FORMAT_USHORT, "wide.png"), true);
}

static void the_greater_value_is_the_object_of_inverted_masks_too(void **state)
{
    (void)state;
    uint8_t codes[PIXELS];
    img mask;
    fill(7, 3, codes);
    assert_int_equal(img_read_mask(save_grey(codes, "inverted.png"), &mask), OK);
    for (int i = 0; i < PIXELS; i++)
        assert_true(mask.data[i] == (is_object(i) ? 0.0f : 1.0f));
    img_free(&mask);
}

static void the_brighter_of_two_colours_is_the_object(void **state)
{
    (void)state;
    static const uint8_t dark[3] = {128, 0, 0};
    uint8_t codes[PIXELS][3] = {{0}};
    for (int i = 0; i < PIXELS; i++)
        if (is_object(i)) memcpy(codes[i], dark, 3);
    assert_selects_object(save(codes, 3, VIPS_FORMAT_UCHAR, "red.png"), true);
    for (int i = 0; i < PIXELS; i++)
        if (!is_object(i)) codes[i][1] = 128;
    assert_refused(save(codes, 3, VIPS_FORMAT_UCHAR, "equal.png"), "two colours that are equally bright");
}

static void a_selection_in_alpha_is_taken(void **state)
{
    (void)state;
    uint8_t codes[PIXELS][4];
    for (int i = 0; i < PIXELS; i++)
        for (int c = 0; c < 4; c++)
            codes[i][c] = c < 3 ? (uint8_t)(i % 251) : is_object(i) ? 1 : 0;
    assert_selects_object(save(codes, 4, VIPS_FORMAT_UCHAR, "alpha.png"), true);
    for (int i = 0; i < PIXELS; i++)
        for (int c = 0; c < 4; c++)
            codes[i][c] = c == 3 ? 254 : is_object(i) ? 9 : 0;
    assert_selects_object(save(codes, 4, VIPS_FORMAT_UCHAR, "even.png"), true);
}

static void soft_edges_keep_their_coverage(void **state)
{
    (void)state;
    uint8_t codes[PIXELS];
    img mask;
    fill(0, 255, codes);
    for (int y = TOP; y < BOTTOM; y++) {
        codes[y * SIDE + LEFT - 1] = (uint8_t)(20 + y);
        codes[y * SIDE + LEFT] = (uint8_t)(200 + y);
    }
    assert_int_equal(img_read_mask(save_grey(codes, "soft.png"), &mask), OK);
    for (int i = 0; i < PIXELS; i++)
        assert_true(mask.data[i] == (float)codes[i] / 255);
    img_free(&mask);
    for (int i = 0; i < PIXELS; i++)
        codes[i] = (uint8_t)(codes[i] / 17); /* 0 to 15 */
    assert_selects_object(save_grey(codes, "dim.png"), false);
    fill(40, 255, codes); /* a dark grey is not a sixth of an object */
    codes[TOP * SIDE + LEFT] = 150;
    assert_selects_object(save_grey(codes, "grey.png"), false);
    assert_int_equal(img_read_mask(scratch_path("grey.png"), &mask), OK);
    assert_true(mask.data[0] == 0 && mask.data[TOP * SIDE + LEFT] > 0.5f && mask.data[TOP * SIDE + LEFT] < 0.52f);
    img_free(&mask);
}

/* Black ink is not quite black. */
static void masks_in_ink_are_what_they_show(void **state)
{
    (void)state;
    uint8_t codes[PIXELS][4];
    for (int i = 0; i < PIXELS; i++)
        memcpy(codes[i], (const uint8_t[]){0, 0, 0, is_object(i) ? 0 : 255}, 4);
    VipsImage *image = vips_image_new_from_memory_copy(codes, sizeof codes, SIDE, SIDE, 4, VIPS_FORMAT_UCHAR), *ink;
    assert_non_null(image);
    assert_int_equal(vips_copy(image, &ink, "interpretation", VIPS_INTERPRETATION_CMYK, NULL), 0);
    static const char *const names[] = {"ink.tif", "ink.jpg"};
    for (int i = 0; i < 2; i++) {
        assert_int_equal(vips_image_write_to_file(ink, scratch_path(names[i]), NULL), 0);
        assert_selects_object(scratch_path(names[i]), i == 0);
    }
    g_object_unref(ink);
    g_object_unref(image);
}

static void noise_of_jpeg_about_two_values_is_no_more_values(void **state)
{
    (void)state;
    static const uint8_t pairs[][2] = {{0, 255}, {0, 60}, {15, 100}, {180, 250}};
    uint8_t codes[PIXELS], seen[256] = {0};
    img mask;
    for (size_t k = 0; k < sizeof pairs / sizeof *pairs; k++) {
        int wrong = 0, values = 0;
        fill(pairs[k][0], pairs[k][1], codes);
        assert_int_equal(img_read_mask(save_grey(codes, "noisy.jpg"), &mask), OK);
        for (int i = 0; i < PIXELS; i++) {
            wrong += (mask.data[i] >= 0.5f) != is_object(i);
            values += !seen[(int)(mask.data[i] * 255)]++;
        }
        assert_int_equal(wrong, 0);
        assert_true(k > 0 || values > 2); /* noise is present */
        img_free(&mask);
    }
}

static void more_areas_than_two_are_refused_by_their_values(void **state)
{
    (void)state;
    static const uint8_t labels[5] = {0, 1, 2, 7, 9}, trimap[3] = {0, 128, 255};
    uint8_t codes[PIXELS], colours[PIXELS][3] = {{0}};
    for (int i = 0; i < PIXELS; i++)
        codes[i] = labels[i / SIDE / 10];
    assert_refused(save_grey(codes, "labels.png"), "5 values (0, 1, 2, 7, 9 of 255): which is the object?");
    for (int i = 0; i < PIXELS; i++)
        codes[i] = trimap[i / SIDE / 16];
    assert_refused(save_grey(codes, "trimap.png"), "3 values (0, 128, 255 of 255)");
    for (int i = 0; i < PIXELS; i++)
        if (i % SIDE > 10) colours[i][i / SIDE / 16] = 255; /* equally bright */
    assert_refused(save(colours, 3, VIPS_FORMAT_UCHAR, "colours.png"), "4 colours (#000000, #");
    uint16_t wide[PIXELS];
    for (int i = 0; i < PIXELS; i++)
        wide[i] = (uint16_t)(i / SIDE / 16);
    assert_refused(save(wide, 1, VIPS_FORMAT_USHORT, "wide.png"), "3 values (0, 1, 2 of 65535)");
}

enum { LARGE = 400 };

/* Saves a disc with a soft edge, as a blur of this standard deviation makes it; beyond: what surrounds a square around
 * it, or -1. */
static const char *save_disc(float blur, int beyond)
{
    uint8_t *codes = malloc(LARGE * LARGE);
    assert_non_null(codes);
    for (int i = 0; i < LARGE * LARGE; i++) {
        const float x = (float)(i % LARGE) - 199.5f, y = (float)(i / LARGE) - 189.5f;
        const float covered = 0.5f * erfcf((sqrtf(x * x + y * y) - 110) / (blur * sqrtf(2)));
        codes[i] = (uint8_t)(beyond >= 0 && i % LARGE < 40 ? beyond : (int)(255 * covered + 0.5f));
    }
    VipsImage *image = vips_image_new_from_memory_copy(codes, LARGE * LARGE, LARGE, LARGE, 1, VIPS_FORMAT_UCHAR);
    free(codes);
    assert_non_null(image);
    assert_int_equal(vips_image_write_to_file(image, scratch_path("disc.png"), NULL), 0);
    g_object_unref(image);
    return scratch_path("disc.png");
}

/* The last steps of a wide soft edge, 254 and 1, are areas of a few pixels' width. */
static void soft_edges_of_any_width_are_no_areas(void **state)
{
    (void)state;
    for (float blur = 0.5f; blur < 25; blur *= 1.25f) {
        img mask;
        if (img_read_mask(save_disc(blur, -1), &mask) != OK) fail_msg("blur %g: %s", (double)blur, status_message());
        for (int i = 0; i < LARGE * LARGE; i++) {
            const float x = (float)(i % LARGE) - 199.5f, y = (float)(i / LARGE) - 189.5f, r = sqrtf(x * x + y * y);
            if (fabsf(r - 110) > 1.5f) assert_int_equal(mask.data[i] >= 0.5f, r < 110);
        }
        img_free(&mask);
    }
    assert_refused(save_disc(3, 128), "areas of ");
    assert_refused(save_disc(12, 128), "areas of ");
}

static void values_that_are_neither_two_nor_half_white_are_refused(void **state)
{
    (void)state;
    uint8_t codes[PIXELS];
    for (int i = 0; i < PIXELS; i++)
        codes[i] = (uint8_t)(i % SIDE * 2);
    assert_refused(save_grey(codes, "ramp.png"), "from 0 to 94 of 255");
}

static void photographs_are_refused(void **state)
{
    (void)state;
    uint8_t grey[PIXELS], colours[PIXELS][3];
    for (int i = 0; i < PIXELS; i++) {
        const int shade = is_object(i) ? 60 + 4 * (i % SIDE) + i / SIDE : 0;
        grey[i] = (uint8_t)(is_object(i) && i / SIDE < TOP + 4 ? 255 : shade); /* burnt out in one part */
        for (int c = 0; c < 3; c++)
            colours[i][c] = (uint8_t)(is_object(i) ? shade - 10 * c : 30 + i % 7 * 9 + c);
    }
    assert_refused(save_grey(grey, "burnt.png"), "looks like a photograph: 68 % of what it shows");
    assert_refused(save(colours, 3, VIPS_FORMAT_UCHAR, "photo.png"), "looks like a photograph");
    assert_refused(save(colours, 3, VIPS_FORMAT_UCHAR, "photo.jpg"), "looks like a photograph");
}

static void floats_beyond_white_have_a_unit_of_their_own(void **state)
{
    (void)state;
    float values[PIXELS];
    for (int i = 0; i < PIXELS; i++)
        values[i] = is_object(i) ? 7 : 1;
    const exr_channel channel = {"Y", values, 1, true};
    assert_int_equal(exr_write(scratch_path("labels.exr"), SIDE, SIDE, &channel, 1, NULL, 0), OK);
    assert_selects_object(scratch_path("labels.exr"), true);
}

static void alpha_of_any_numbers_is_taken(void **state)
{
    (void)state;
    static const float outside[] = {-64, -0.0f, -3e38f, 0.25f}, inside[] = {1, 2, 1e30f, 3e38f};
    float grey[PIXELS] = {0}, values[PIXELS];
    for (size_t k = 0; k < sizeof outside / sizeof outside[0]; k++) {
        for (int i = 0; i < PIXELS; i++)
            values[i] = is_object(i) ? inside[k] : outside[k];
        const exr_channel channels[] = {{"Y", grey, 1, true}, {"A", values, 1, true}};
        assert_int_equal(exr_write(scratch_path("cut.exr"), SIDE, SIDE, channels, 2, NULL, 0), OK);
        assert_selects_object(scratch_path("cut.exr"), true);
    }
}

static void one_value_stays_what_it_is(void **state)
{
    (void)state;
    uint8_t codes[PIXELS];
    img mask;
    for (int white = 0; white < 2; white++) {
        memset(codes, white ? 255 : 0, sizeof codes);
        assert_int_equal(img_read_mask(save_grey(codes, "even.png"), &mask), OK);
        for (int i = 0; i < PIXELS; i++)
            assert_true(mask.data[i] == (float)white);
        img_free(&mask);
    }
}

static void a_map_of_numbers_is_no_mask(void **state)
{
    (void)state;
    uint8_t codes[PIXELS];
    img grey;
    fill(51, 102, codes);
    assert_int_equal(img_read_grey(save_grey(codes, "roughness.png"), &grey), OK);
    for (int i = 0; i < PIXELS; i++)
        assert_float_equal(grey.data[i], is_object(i) ? 0.4 : 0.2, 1e-6);
    img_free(&grey);
}

static int start(void **state)
{
    return VIPS_INIT("test") || scratch_open(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_values_are_a_mask_whatever_they_are),
        cmocka_unit_test(the_greater_value_is_the_object_of_inverted_masks_too),
        cmocka_unit_test(the_brighter_of_two_colours_is_the_object),
        cmocka_unit_test(a_selection_in_alpha_is_taken),
        cmocka_unit_test(soft_edges_keep_their_coverage),
        cmocka_unit_test(noise_of_jpeg_about_two_values_is_no_more_values),
        cmocka_unit_test(more_areas_than_two_are_refused_by_their_values),
        cmocka_unit_test(soft_edges_of_any_width_are_no_areas),
        cmocka_unit_test(masks_in_ink_are_what_they_show),
        cmocka_unit_test(values_that_are_neither_two_nor_half_white_are_refused),
        cmocka_unit_test(photographs_are_refused),
        cmocka_unit_test(floats_beyond_white_have_a_unit_of_their_own),
        cmocka_unit_test(alpha_of_any_numbers_is_taken),
        cmocka_unit_test(one_value_stays_what_it_is),
        cmocka_unit_test(a_map_of_numbers_is_no_mask),
    };
    return cmocka_run_group_tests(tests, start, scratch_close);
}
