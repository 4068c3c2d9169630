/* SPDX-License-Identifier: MIT */
/* Colour profiles for integers and for floats, with alpha, and of grey pictures. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "image/metadata/icc.h"
#include "image/read/read.h"

/* last, as cmocka defines a macro named fail */
#include "scratch.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

typedef struct bytes {
    unsigned char at[4096];
    size_t size;
} bytes;

static void big(bytes *b, uint32_t value, int count)
{
    while (count--)
        b->at[b->size++] = (unsigned char)(value >> 8 * count);
}

static void word(bytes *b, const char *four)
{
    memcpy(b->at + b->size, four, 4);
    b->size += 4;
}

static void fixed(bytes *b, double v)
{
    big(b, (uint32_t)(int32_t)lround(v * 65536), 4);
}

/* Makes a profile of Display P3's primaries under D50 (columns), or of grey, with the curve light = code^gamma. */
static bytes make_profile(bool grey, double gamma)
{
    static const double p3[3][3] = {
        {0.51512, 0.24120, -0.00105}, {0.29198, 0.69225, 0.04189}, {0.15710, 0.06657, 0.78407}};
    static const char *const names[3][2] = {{"rXYZ", "rTRC"}, {"gXYZ", "gTRC"}, {"bXYZ", "bTRC"}};
    bytes b = {{0}, 128};
    const int colours = grey ? 0 : 3, tags = grey ? 2 : 7, first = 128 + 4 + 12 * tags,
              curve_at = first + 20 * (colours + 1);
    memcpy(b.at + 8, "\2\20\0\0mntr", 8);
    memcpy(b.at + 16, grey ? "GRAY" : "RGB ", 4);
    memcpy(b.at + 20, "XYZ ", 4);
    memcpy(b.at + 36, "acsp", 4);
    memcpy(b.at + 68, "\0\0\366\326\0\1\0\0\0\0\323-", 12); /* D50 */
    big(&b, (uint32_t)tags, 4);
    word(&b, "wtpt"), big(&b, (uint32_t)first, 4), big(&b, 20, 4);
    for (int i = 0; i < colours; i++) {
        word(&b, names[i][0]), big(&b, (uint32_t)(first + 20 * (i + 1)), 4), big(&b, 20, 4);
        word(&b, names[i][1]), big(&b, (uint32_t)curve_at, 4), big(&b, 16, 4);
    }
    if (grey) word(&b, "kTRC"), big(&b, (uint32_t)curve_at, 4), big(&b, 16, 4);
    word(&b, "XYZ "), big(&b, 0, 4), fixed(&b, 0.9642), fixed(&b, 1), fixed(&b, 0.8249);
    for (int i = 0; i < colours; i++) {
        word(&b, "XYZ "), big(&b, 0, 4);
        for (int k = 0; k < 3; k++)
            fixed(&b, p3[i][k]);
    }
    word(&b, "curv"), big(&b, 0, 4), big(&b, 1, 4), big(&b, (uint32_t)lround(gamma * 256), 2), big(&b, 0, 2);
    memcpy(b.at, (unsigned char[]){0, 0, (unsigned char)(b.size >> 8), (unsigned char)b.size}, 4);
    return b;
}

/* A TIFF of 4 × 4 equal pixels, little-endian. */
typedef struct picture {
    int bands;
    bool alpha, floats;
    double value[4];
} picture;

static void little(FILE *f, uint32_t value, int count)
{
    for (int i = 0; i < count; i++)
        fputc((int)(value >> 8 * i & 255), f);
}

static void entry(FILE *f, uint32_t tag, uint32_t type, uint32_t count, uint32_t value)
{
    little(f, tag, 2), little(f, type, 2), little(f, count, 4), little(f, value, 4);
}

static const char *write_tiff(const picture *p, const bytes *profile)
{
    enum { ENTRIES = 12, PIXELS = 16, HEAD = 8 + 2 + 12 * ENTRIES + 4 };
    const char *path = scratch_path("profiled.tif");
    const uint32_t size = p->floats ? 4 : 1, bits = 8 * size, bands = (uint32_t)p->bands, bits_at = HEAD,
                   profile_at = bits_at + 8, pixels_at = profile_at + (uint32_t)profile->size + profile->size % 2;
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    fputs("II*", f), fputc(0, f), little(f, 8, 4), little(f, ENTRIES, 2);
    entry(f, 256, 3, 1, 4), entry(f, 257, 3, 1, 4);
    entry(f, 258, 3, bands, bands == 1 ? bits : bands == 2 ? bits | bits << 16 : bits_at);
    entry(f, 259, 3, 1, 1), entry(f, 262, 3, 1, bands > 2 ? 2 : 1), entry(f, 273, 4, 1, pixels_at);
    entry(f, 277, 3, 1, bands), entry(f, 278, 3, 1, 4), entry(f, 279, 4, 1, PIXELS * bands * size);
    entry(f, 338, 3, p->alpha, p->alpha ? 2 : 0), entry(f, 339, 3, 1, p->floats ? 3 : 1);
    entry(f, 34675, 7, (uint32_t)profile->size, profile_at), little(f, 0, 4);
    for (int i = 0; i < 4; i++)
        little(f, bits, 2);
    fwrite(profile->at, 1, profile->size, f), fwrite("", 1, profile->size % 2, f);
    for (uint32_t i = 0; i < PIXELS * bands; i++) {
        const float value = (float)p->value[i % bands];
        if (p->floats)
            fwrite(&value, sizeof value, 1, f);
        else
            fputc((int)lroundf(255 * value), f);
    }
    assert_int_equal(fclose(f), 0);
    return path;
}

static void expect(const picture *p, const bytes *profile, double red, double green, double blue, double alpha)
{
    img color = {0}, cover = {0};
    const char *path = write_tiff(p, profile);
    if (img_read(path, &color, &cover) != OK) fail_msg("%s", status_message());
    const double wanted[3] = {red, green, blue};
    for (int c = 0; c < 3; c++)
        if (!(fabs((double)color.data[c] - wanted[c]) < 0.006)) /* 8 bits of code and a profile's 16 bits */
            fail_msg("channel %d is %g, not %g", c, (double)color.data[c], wanted[c]);
    assert_int_equal(cover.data != NULL, p->alpha);
    if (p->alpha) assert_true(fabs((double)cover.data[0] - alpha) < 0.003);
    img_free(&color);
    img_free(&cover);
}

/* Converts light from Display P3's primaries to linear sRGB. */
#define OF_P3(r, g, b)                                                                                                 \
    1.22494 * (r)-0.22494 * (g), -0.04206 * (r) + 1.04206 * (g), -0.01964 * (r)-0.07864 * (g) + 1.09827 * (b)

static void alpha_beside_a_profile_stays_what_it_is(void **state)
{
    (void)state;
    const bytes profile = make_profile(false, 2);
    expect(&(picture){4, true, false, {0.8, 0.6, 0.4, 1}}, &profile, OF_P3(0.64, 0.36, 0.16), 1);
    expect(&(picture){4, true, false, {0.8, 0.6, 0.4, 0.6}}, &profile, OF_P3(0.64, 0.36, 0.16), 0.6);
    expect(&(picture){3, false, false, {0.8, 0.6, 0.4}}, &profile, OF_P3(0.64, 0.36, 0.16), 1);
}

static void floats_go_by_their_profiles_curve_and_primaries(void **state)
{
    (void)state;
    const bytes curved = make_profile(false, 2), linear = make_profile(false, 1);
    expect(&(picture){3, false, true, {0.8, 0.6, 0.4}}, &curved, OF_P3(0.64, 0.36, 0.16), 1);
    expect(&(picture){3, false, true, {0.8, 0.6, 0.4}}, &linear, OF_P3(0.8, 0.6, 0.4), 1);
    expect(&(picture){3, false, true, {3, 2, 1.5}}, &linear, OF_P3(3, 2, 1.5), 1);
}

static void grey_goes_by_a_profile_of_colours(void **state)
{
    (void)state;
    const bytes colours = make_profile(false, 1.5), grey = make_profile(true, 1.5);
    const double light = pow(0.6, 1.5);
    expect(&(picture){1, false, false, {0.6}}, &colours, light, light, light, 1);
    expect(&(picture){2, true, false, {0.6, 0.4}}, &colours, light, light, light, 0.4);
    expect(&(picture){1, false, false, {0.6}}, &grey, light, light, light, 1);
    expect(&(picture){2, true, false, {0.6, 0.4}}, &grey, light, light, light, 0.4);
}

static void a_profile_of_other_channels_is_not_heeded(void **state)
{
    (void)state;
    const bytes grey = make_profile(true, 1);
    const double light = pow((0.8 + 0.055) / 1.055, 2.4);
    expect(&(picture){3, false, false, {0.8, 0.8, 0.8}}, &grey, light, light, light, 1);
}

static void floats_of_a_profile_that_is_not_known_are_refused(void **state)
{
    (void)state;
    bytes profile = make_profile(false, 2);
    img color = {0}, cover = {0};
    memcpy(profile.at + 132, "A2B0", 4); /* its first tag; what it points at does not matter */
    const char *path = write_tiff(&(picture){3, false, true, {0.8, 0.6, 0.4}}, &profile);
    assert_int_equal(img_read(path, &color, &cover), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "colour profile"));
}

static void damaged_profiles_say_nothing(void **state)
{
    (void)state;
    const bytes whole = make_profile(false, 2);
    picture_light light;
    assert_true(icc_light(whole.at, whole.size, &light) && light.curve == PICTURE_CURVE_POWER);
    assert_true(fabsf(light.exponent - 2) < 0.01f);
    for (size_t size = 0; size < whole.size - 4; size++) {
        unsigned char *part = malloc(size + 1); /* allocated separately, so that a sanitizer sees accesses beyond it */
        memcpy(part, whole.at, size);
        assert_false(icc_light(part, size, &light));
        free(part);
    }
    for (size_t i = 0; i < whole.size; i++) {
        bytes other = whole;
        other.at[i] ^= 0xff;
        (void)icc_light(other.at, other.size, &light);
        (void)icc_channels(other.at, other.size);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(alpha_beside_a_profile_stays_what_it_is),
        cmocka_unit_test(floats_go_by_their_profiles_curve_and_primaries),
        cmocka_unit_test(grey_goes_by_a_profile_of_colours),
        cmocka_unit_test(a_profile_of_other_channels_is_not_heeded),
        cmocka_unit_test(floats_of_a_profile_that_is_not_known_are_refused),
        cmocka_unit_test(damaged_profiles_say_nothing),
    };
    return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
