/* SPDX-License-Identifier: MIT */
/* Pictures for the tests of reading: saved by libvips, or written byte by byte. */
#ifndef MERLIN_TESTS_IMAGE_READ_FIXTURE_H
#define MERLIN_TESTS_IMAGE_READ_FIXTURE_H

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

/* Returns a libvips image of 8- or 16-bit codes. */
static inline VipsImage *fixture(const void *codes, int width, int height, int bands, VipsInterpretation interpretation)
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

/* Saves in the format of the name's extension and frees the image. */
static inline const char *save(VipsImage *image, const char *name)
{
    const char *path = scratch_path(name);
    if (vips_image_write_to_file(image, path, NULL)) print_error("%s", vips_error_buffer());
    g_object_unref(image);
    assert_true(file_exists(path));
    return path;
}

/* Returns 16 × 8 pixels: left half red, right half blue, upper half bright. */
static inline VipsImage *quarters(void)
{
    uint8_t codes[8][16][3] = {0};
    for (int y = 0; y < 8; y++)
        for (int x = 0; x < 16; x++)
            codes[y][x][x < 8 ? 0 : 2] = y < 4 ? 250 : 100;
    return fixture(codes, 16, 8, 3, VIPS_INTERPRETATION_sRGB);
}

enum { PHOTOMETRIC_RGB = 2, PHOTOMETRIC_YCBCR = 6 };

/* Writes a TIFF of one line of two pixels, three colours and alpha in 32-bit floats; extra: the kind of alpha. */
static inline void write_tiff(const char *path, const float pixels[8], uint16_t extra, uint16_t photometric)
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

static inline const char *save_quarters_in(VipsInterpretation space, const char *name)
{
    VipsImage *light = quarters(), *other = NULL;
    assert_int_equal(vips_colourspace(light, &other, space, NULL), 0);
    g_object_unref(light);
    return save(other, name);
}

static inline int start(void **state)
{
    return VIPS_INIT("test") || scratch_open(state);
}

#endif
