/* SPDX-License-Identifier: MIT */
/* What pictures state about their colours outside PNG's chunks: TIFF's tags, EXIF, the code points of HEIC and AVIF. */
#include <math.h>
#include <vips/vips.h>

#include "image/color.h"
#include "image/read/read.h"
#include "image/write/write.h"

#include "writes.h"

enum { SHORT = 3, LONG = 4, RATIONAL = 5 };

typedef struct file_bytes {
    size_t count;
    uint8_t at[8192];
} file_bytes;

static void put(file_bytes *b, size_t size, uint64_t value)
{
    for (size_t i = 0; i < size; i++)
        b->at[b->count++] = (uint8_t)(value >> (8 * i));
}

static const char *save(const file_bytes *b, const char *name)
{
    assert_int_equal(file_write(scratch_path(name), b->at, b->count), OK);
    return scratch_path(name);
}

static void put_entry(file_bytes *b, unsigned tag, unsigned type, unsigned count, unsigned value)
{
    put(b, 2, tag);
    put(b, 2, type);
    put(b, 4, count);
    put(b, 4, value);
}

typedef struct tiff_words {
    unsigned meaning, samples, bits, format;
    const uint16_t *transfer;  /* 256 entries */
    const uint32_t *primaries; /* six, times 1000 */
} tiff_words;

/* Writes a TIFF of one pixel of codes 128, 50, 20 with these tags. */
static const char *write_tiff(const tiff_words *w)
{
    enum { PIXEL = 8, TRANSFER = 40, PRIMARIES = TRANSFER + 512, PAGE = PRIMARIES + 48 };
    static const uint8_t codes[3] = {128, 50, 20};
    file_bytes b = {0};
    memcpy(b.at, "II*", 4);
    b.count = 4;
    put(&b, 4, PAGE);
    for (unsigned i = 0; i < w->samples; i++)
        put(&b, w->bits / 8, w->bits == 8 ? codes[i] : 0);
    b.count = TRANSFER;
    for (int i = 0; i < 256; i++)
        put(&b, 2, w->transfer ? w->transfer[i] : 0);
    for (int i = 0; i < 6; i++) {
        put(&b, 4, w->primaries ? w->primaries[i] : 0);
        put(&b, 4, 1000);
    }
    put(&b, 2, 9U + (w->transfer != NULL) + (w->primaries != NULL) + (w->format > 0));
    put_entry(&b, 256, SHORT, 1, 1);
    put_entry(&b, 257, SHORT, 1, 1);
    put_entry(&b, 258, SHORT, 1, w->bits);
    put_entry(&b, 259, SHORT, 1, 1);
    put_entry(&b, 262, SHORT, 1, w->meaning);
    put_entry(&b, 273, LONG, 1, PIXEL);
    put_entry(&b, 277, SHORT, 1, w->samples);
    put_entry(&b, 278, SHORT, 1, 1);
    put_entry(&b, 279, LONG, 1, w->samples * w->bits / 8);
    if (w->transfer) put_entry(&b, 301, SHORT, 256, TRANSFER);
    if (w->primaries) put_entry(&b, 319, RATIONAL, 6, PRIMARIES);
    if (w->format) put_entry(&b, 339, SHORT, 1, w->format);
    put(&b, 4, 0);
    return save(&b, "a.tif");
}

static void assert_pixel(const char *path, double red, double green, double blue, double within)
{
    img color = {0};
    if (img_read(path, &color, NULL) != OK) fail_msg("%s", status_message());
    const double want[3] = {red, green, blue};
    for (int c = 0; c < 3; c++)
        if (fabs((double)color.data[c] - want[c]) > within)
            fail_msg("channel %d is %g, not %g", c, (double)color.data[c], want[c]);
    img_free(&color);
}

static void assert_refused(const char *path, const char *words)
{
    img color = {0};
    assert_int_equal(img_read(path, &color, NULL), MERLIN_BAD_INPUT);
    if (!strstr(status_message(), words)) fail_msg("%s", status_message());
}

static void the_curve_in_a_tiff_is_heeded(void **state)
{
    (void)state;
    uint16_t curve[256];
    for (int i = 0; i < 256; i++)
        curve[i] = (uint16_t)(i * 257);
    assert_pixel(write_tiff(&(tiff_words){1, 1, 8, 0, curve, NULL}), 128 / 255.0, 128 / 255.0, 128 / 255.0, 1e-4);
    for (int i = 0; i < 256; i++)
        curve[i] = (uint16_t)lrint(65535 * pow(i / 255.0, 1.8));
    double power = pow(128 / 255.0, 1.8);
    assert_pixel(write_tiff(&(tiff_words){1, 1, 8, 0, curve, NULL}), power, power, power, 1e-4);
    for (int i = 0; i < 256; i++)
        curve[i] = (uint16_t)lrintf(65535 * srgb_decode((float)i / 255));
    double srgb = (double)srgb_decode(128 / 255.0f);
    assert_pixel(write_tiff(&(tiff_words){1, 1, 8, 0, curve, NULL}), srgb, srgb, srgb, 1e-6);
    for (int i = 0; i < 256; i++)
        curve[i] = (uint16_t)(65535 - i * 257);
    assert_refused(write_tiff(&(tiff_words){1, 1, 8, 0, curve, NULL}), "TransferFunction");
}

/* The primaries are Adobe RGB's, whose red is sRGB's (by matrices of the standard: 1.3983 - 0.3983; 1; -0.0429 +
 * 1.0429). */
static void the_primaries_in_a_tiff_are_heeded(void **state)
{
    (void)state;
    static const uint32_t adobe[6] = {640, 330, 210, 710, 150, 60};
    double r = (double)srgb_decode(128 / 255.0f), g = (double)srgb_decode(50 / 255.0f),
           b = (double)srgb_decode(20 / 255.0f);
    assert_pixel(write_tiff(&(tiff_words){2, 3, 8, 0, NULL, adobe}), 1.3983 * r - 0.3983 * g, g,
                 1.0429 * b - 0.0429 * g, 1e-4);
    assert_pixel(write_tiff(&(tiff_words){2, 3, 8, 0, NULL, NULL}), r, g, b, 1e-6);
}

static void samples_of_a_tiff_that_are_not_read_are_named(void **state)
{
    (void)state;
    assert_refused(write_tiff(&(tiff_words){9, 3, 8, 0, NULL, NULL}), "ICC L*a*b*");
    assert_refused(write_tiff(&(tiff_words){1, 1, 16, 2, NULL, NULL}), "with a sign of 16 bits");
    assert_refused(write_tiff(&(tiff_words){1, 1, 64, 3, NULL, NULL}), "floats of 64 bits");
    assert_refused(write_tiff(&(tiff_words){1, 1, 32, 1, NULL, NULL}), "whole numbers of 32 bits");
}

/* Writes EXIF with a colour space and a rule of DCF, after the first two bytes of a JPEG. */
static const char *write_jpeg(unsigned space, const char *rule)
{
    enum { EXIF_PAGE = 26, RULES_PAGE = EXIF_PAGE + 30 };
    img grey;
    uint8_t *data;
    size_t size;
    file_bytes exif = {0}, b = {0};
    assert_int_equal(img_new(&grey, 8, 8, 3), OK);
    for (size_t i = 0; i < img_value_count(&grey); i++)
        grey.data[i] = i % 3 == 0 ? srgb_decode(200 / 255.0f) : i % 3 == 1 ? srgb_decode(100 / 255.0f) : 0.0319f;
    assert_int_equal(img_encode_picture("a.jpg", &grey, IMG_JPEG, &data, &size), OK);
    img_free(&grey);
    memcpy(exif.at, "II*\0\10\0\0", 8);
    exif.count = 8;
    put(&exif, 2, 1);
    put_entry(&exif, 34665, LONG, 1, EXIF_PAGE);
    put(&exif, 4, 0);
    put(&exif, 2, 2);
    put_entry(&exif, 40961, SHORT, 1, space);
    put_entry(&exif, 40965, LONG, 1, RULES_PAGE);
    put(&exif, 4, 0);
    put(&exif, 2, 1);
    put(&exif, 2, 1);
    put(&exif, 2, 2);
    put(&exif, 4, 4);
    memcpy(exif.at + exif.count, rule, 4);
    exif.count += 4;
    put(&exif, 4, 0);
    put(&b, 4, 0xe1ffd8ff);
    put(&b, 2, (exif.count + 8) >> 8 | ((exif.count + 8) & 255) << 8);
    memcpy(b.at + b.count, "Exif\0", 6);
    memcpy(b.at + b.count + 6, exif.at, exif.count);
    b.count += 6 + exif.count;
    memcpy(b.at + b.count, data + 2, size - 2);
    b.count += size - 2;
    free(data);
    return save(&b, "a.jpg");
}

static void a_jpeg_that_says_adobe_rgb_in_exif_is_brought_to_srgb(void **state)
{
    (void)state;
    /* 200, 100, 50 to the power of 563/256, times the standard's matrix; 0.02: two codes of JPEG */
    assert_pixel(write_jpeg(0xffff, "R03"), 0.7687, 0.1276, 0.0235, 0.02);
    assert_pixel(write_jpeg(2, "R98"), 0.7687, 0.1276, 0.0235, 0.02);
    assert_pixel(write_jpeg(1, "R98"), 0.5776, 0.1274, 0.0319, 0.02);
    assert_pixel(write_jpeg(0xffff, "R98"), 0.5776, 0.1274, 0.0319, 0.02);
}

/* Changes the code points in a picture's file. */
static void state_numbers(const char *path, unsigned primaries, unsigned transfer)
{
    char *data;
    size_t size;
    assert_int_equal(file_read(path, 1 << 20, &data, &size), OK);
    uint8_t *at = memmem(data, size, "nclx", 4);
    assert_non_null(at);
    at[4] = at[6] = 0;
    at[5] = (uint8_t)primaries;
    at[7] = (uint8_t)transfer;
    assert_int_equal(file_write(path, data, size), OK);
    free(data);
}

static void the_numbers_of_an_avif_are_heeded(void **state)
{
    (void)state;
    uint8_t codes[64][3];
    for (int i = 0; i < 64; i++)
        memcpy(codes[i], (const uint8_t[3]){200, 100, 50}, 3);
    VipsImage *image = vips_image_new_from_memory_copy(codes, sizeof codes, 8, 8, 3, VIPS_FORMAT_UCHAR), *named = NULL;
    assert_int_equal(vips_copy(image, &named, "interpretation", VIPS_INTERPRETATION_sRGB, NULL), 0);
    const char *path = scratch_path("a.avif");
    int failed = !vips_type_find("VipsOperation", "heifsave") ||
                 vips_heifsave(named, path, "compression", VIPS_FOREIGN_HEIF_COMPRESSION_AV1, "Q", 95, NULL);
    g_object_unref(named);
    g_object_unref(image);
    if (failed) {
        vips_error_clear();
        skip();
    }
    state_numbers(path, 1, 13);
    assert_pixel(path, 0.5776, 0.1274, 0.0319, 0.02);
    state_numbers(path, 1, 8);
    assert_pixel(path, 200 / 255.0, 100 / 255.0, 50 / 255.0, 0.015);
    state_numbers(path, 12, 13); /* Display P3: 1.2249 - 0.2249; -0.0421 + 1.0421; -0.0196 - 0.0786 + 1.0983 */
    assert_pixel(path, 0.6788, 0.1085, 0.0137, 0.02);
    state_numbers(path, 1, 9);
    assert_refused(path, "transfer 9");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        in_scratch(the_curve_in_a_tiff_is_heeded),
        in_scratch(the_primaries_in_a_tiff_are_heeded),
        in_scratch(samples_of_a_tiff_that_are_not_read_are_named),
        in_scratch(a_jpeg_that_says_adobe_rgb_in_exif_is_brought_to_srgb),
        in_scratch(the_numbers_of_an_avif_are_heeded),
    };
    if (vips_init("test_colour_words")) return 1;
    return cmocka_run_group_tests(tests, NULL, NULL);
}
