/* SPDX-License-Identifier: MIT */
/* Converts between images and pixels in a caller's buffer, without a file (merlin/image.h). */
#include <stdint.h>
#include <string.h>

#include "base/api_needs.h"
#include "base/number.h"
#include "image/color.h"
#include "image/coverage.h"
#include "image/image.h"

enum { ALPHA = 3 };
static const float HALF = 0.5f;

static size_t value_size(merlin_pixel_type type)
{
    return type == MERLIN_PIXEL_8 ? sizeof(uint8_t) : type == MERLIN_PIXEL_16 ? sizeof(uint16_t) : sizeof(float);
}

/* Checks the layout, and how its rows follow each other. */
static status check_layout(const merlin_pixel_layout *l)
{
    if (l->width < 1 || l->height < 1)
        return fail(MERLIN_WRONG_USE, "pixels of %d x %d cannot be", l->width, l->height);
    if (l->channels != 1 && l->channels != 3 && l->channels != 4)
        return fail(MERLIN_WRONG_USE, "pixels have 1, 3 or 4 channels, not %d", l->channels);
    if ((int)l->type < MERLIN_PIXEL_8 || (int)l->type > MERLIN_PIXEL_FLOAT)
        return fail(MERLIN_WRONG_USE, "no type of pixels has the number %d", (int)l->type);
    const size_t row = (size_t)l->width * (size_t)l->channels * value_size(l->type);
    const size_t stride = l->stride < 0 ? (size_t)0 - (size_t)l->stride : (size_t)l->stride;
    if (l->stride != 0 && stride < row)
        return fail(MERLIN_WRONG_USE, "a row of these pixels takes %zu bytes, more than their stride of %zu", row,
                    stride);
    return OK;
}

/* Returns how many bytes row y begins behind the first. */
static ptrdiff_t row_offset(const merlin_pixel_layout *l, int y)
{
    const size_t row = (size_t)l->width * (size_t)l->channels * value_size(l->type);
    return (l->stride != 0 ? l->stride : (ptrdiff_t)row) * y;
}

/* ---- from a buffer ---- */

/* Reads a value that need not be aligned; `linear`: its code is not sRGB's. */
static float read_value(const char *at, merlin_pixel_type type, bool linear)
{
    uint16_t wide;
    float value;
    switch (type) {
    case MERLIN_PIXEL_8:
        return linear ? (float)*(const uint8_t *)at / 255 : srgb_decode_table8()[*(const uint8_t *)at];
    case MERLIN_PIXEL_16:
        memcpy(&wide, at, sizeof wide);
        return linear ? (float)wide / 65535 : srgb_decode_table16()[wide];
    case MERLIN_PIXEL_FLOAT:
    default:
        memcpy(&value, at, sizeof value);
        return linear ? value : srgb_decode(value);
    }
}

/* Grey becomes three channels; alpha may be without data. */
static void read_pixels(const void *pixels, const merlin_pixel_layout *l, img *color, img *alpha)
{
    const size_t size = value_size(l->type);
    for (int y = 0; y < l->height; y++) {
        const char *at = (const char *)pixels + row_offset(l, y);
        for (int x = 0; x < l->width; x++, at += (size_t)l->channels * size) {
            float *out = img_at(color, x, y);
            for (size_t c = 0; c < 3; c++)
                out[c] = read_value(at + (l->channels == 1 ? 0 : c) * size, l->type, l->linear != 0);
            if (alpha->data) *img_at(alpha, x, y) = read_value(at + ALPHA * size, l->type, true);
        }
    }
}

/* Drops an alpha that is opaque everywhere; refuses one that shows nothing. */
static status check_alpha(img *alpha)
{
    if (coverage_is_transparent(alpha))
        return fail(MERLIN_BAD_INPUT, "the pixels are transparent everywhere, so their alpha shows no object");
    if (coverage_is_opaque(alpha)) img_free(alpha);
    return OK;
}

merlin_status merlin_image_from_pixels(const void *pixels, const merlin_pixel_layout *layout, merlin_image *color,
                                       merlin_image *alpha)
{
    if (color) *color = (merlin_image){0};
    if (alpha) *alpha = (merlin_image){0};
    status s = api_needs(__func__, pixels && layout && color);
    if (s == OK) s = check_layout(layout);
    if (s != OK) return s;
    img made = {0}, cover = {0};
    const bool wants_alpha = alpha && layout->channels == 4;
    s = img_new(&made, layout->width, layout->height, 3);
    if (s == OK && wants_alpha) s = img_new(&cover, layout->width, layout->height, 1);
    if (s == OK) read_pixels(pixels, layout, &made, &cover);
    if (s == OK && wants_alpha) s = check_alpha(&cover);
    if (s != OK) {
        img_free(&made);
        img_free(&cover);
        return s;
    }
    *color = made;
    if (alpha) *alpha = cover;
    return OK;
}

merlin_status merlin_mask_from_pixels(const void *pixels, const merlin_pixel_layout *layout, merlin_image *mask)
{
    if (mask) *mask = (merlin_image){0};
    status s = api_needs(__func__, pixels && layout && mask);
    if (s == OK) s = check_layout(layout);
    if (s == OK && layout->channels != 1)
        s = fail(MERLIN_WRONG_USE, "a mask's pixels have 1 channel, not %d", layout->channels);
    if (s == OK) s = img_new(mask, layout->width, layout->height, 1);
    for (int y = 0; s == OK && y < layout->height; y++) {
        const char *row = (const char *)pixels + row_offset(layout, y);
        for (int x = 0; x < layout->width; x++)
            *img_at(mask, x, y) = read_value(row + (size_t)x * value_size(layout->type), layout->type, true);
    }
    return s;
}

/* ---- into a buffer ---- */

static void write_value(float value, merlin_pixel_type type, bool linear, char *at)
{
    uint16_t wide;
    float encoded;
    switch (type) {
    case MERLIN_PIXEL_8:
        *(uint8_t *)at = linear ? (uint8_t)(clamp(value, 0, 1) * 255 + HALF) : srgb_code8(value);
        return;
    case MERLIN_PIXEL_16:
        wide = (uint16_t)((linear ? clamp(value, 0, 1) : srgb_encode(clamp(value, 0, 1))) * 65535 + HALF);
        memcpy(at, &wide, sizeof wide);
        return;
    case MERLIN_PIXEL_FLOAT:
    default:
        encoded = linear ? value : srgb_encode(value);
        memcpy(at, &encoded, sizeof encoded);
    }
}

static void write_row(const merlin_image *image, const merlin_image *alpha, const merlin_pixel_layout *l, int y,
                      char *at)
{
    const size_t size = value_size(l->type);
    const int colors = l->channels == 1 ? 1 : 3;
    for (int x = 0; x < l->width; x++, at += (size_t)l->channels * size) {
        const float *from = img_at(image, x, y);
        for (int c = 0; c < colors; c++)
            write_value(from[image->channels == 1 ? 0 : c], l->type, l->linear != 0, at + (size_t)c * size);
        if (l->channels == 4) write_value(alpha ? *img_at(alpha, x, y) : 1, l->type, true, at + ALPHA * size);
    }
}

/* Checks that an image can be written by this layout. */
static status check_source(const merlin_image *image, const merlin_image *alpha, const merlin_pixel_layout *l)
{
    if (!image->data || image->width != l->width || image->height != l->height)
        return fail(MERLIN_WRONG_USE, "an image of %d x %d does not fit pixels of %d x %d", image->width, image->height,
                    l->width, l->height);
    if (image->channels != 1 && (image->channels != 3 || l->channels == 1))
        return fail(MERLIN_WRONG_USE, "an image of %d channels does not become pixels of %d", image->channels,
                    l->channels);
    if (alpha && (!alpha->data || alpha->channels != 1 || alpha->width != l->width || alpha->height != l->height))
        return fail(MERLIN_WRONG_USE, "the alpha is not 1 channel of the image's size");
    return OK;
}

merlin_status merlin_image_to_pixels(const merlin_image *image, const merlin_image *alpha,
                                     const merlin_pixel_layout *layout, void *pixels)
{
    status s = api_needs(__func__, image && layout && pixels);
    if (s == OK) s = check_layout(layout);
    if (s == OK) s = check_source(image, alpha, layout);
    for (int y = 0; s == OK && y < layout->height; y++)
        write_row(image, alpha, layout, y, (char *)pixels + row_offset(layout, y));
    return s;
}
