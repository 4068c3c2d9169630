/* SPDX-License-Identifier: MIT */
/* Floats as packed in TIFF and DNG: Adobe's TIFF technical note 3 (the floating-point predictor), and the DNG
 * specification's floats of 16 and 24 bits. */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "image/formats/float_part.h"

enum { PLAIN = 1, DEFLATE = 8, OLD_DEFLATE = 32946 };
enum {
    OF_FLOATS = 3,
    OF_FLOATS_2 = 34894,
    OF_FLOATS_4 = 34895
}; /* predictors: from the sample 1, 2 or 4 pixels before */

/* Assembles a float from a code of a sign bit, an exponent and a fraction. */
static float float_of(uint32_t code, int exponent_bits, int fraction_bits)
{
    uint32_t fraction = code & ((1U << fraction_bits) - 1);
    int most = (1 << exponent_bits) - 1, bias = most / 2, exponent = (int)(code >> fraction_bits) & most;
    float sign = code >> (exponent_bits + fraction_bits) & 1 ? -1 : 1;
    if (exponent == most) return fraction ? NAN : sign * INFINITY;
    uint32_t whole = exponent ? fraction | 1U << fraction_bits : fraction;
    return sign * ldexpf((float)whole, (exponent ? exponent : 1) - bias - fraction_bits);
}

static float float_of_bits(uint32_t code, int bits)
{
    float value;
    memcpy(&value, &code, sizeof value);
    return bits == 16 ? float_of(code, 5, 10) : bits == 24 ? float_of(code, 7, 16) : value;
}

/* Reverts the floating-point predictor for a row: its bytes are differences, all most significant bytes first, then all
 * second ones, and so on. */
static void undo_predictor(const float_parts *p, uint8_t *row, float *out)
{
    int apart = p->predictor == OF_FLOATS_2 ? 2 : p->predictor == OF_FLOATS_4 ? 4 : 1;
    size_t bytes = (size_t)p->bits / 8, count = (size_t)p->part_width * (size_t)p->samples;
    size_t step = (size_t)apart * (size_t)p->samples;
    for (size_t i = step; i < count * bytes; i++)
        row[i] = (uint8_t)(row[i] + row[i - step]);
    for (size_t i = 0; i < count; i++) {
        uint32_t code = 0;
        for (size_t k = 0; k < bytes; k++)
            code = code << 8 | row[k * count + i];
        out[i] = float_of_bits(code, p->bits);
    }
}

static void take_row(const float_parts *p, const uint8_t *row, float *out)
{
    size_t bytes = (size_t)p->bits / 8, count = (size_t)p->part_width * (size_t)p->samples;
    for (size_t i = 0; i < count; i++) {
        uint32_t code = 0;
        for (size_t k = 0; k < bytes; k++)
            code = code << 8 | row[i * bytes + (p->big_endian ? k : bytes - 1 - k)];
        out[i] = float_of_bits(code, p->bits);
    }
}

bool float_part_unpack(const float_parts *p, struct libdeflate_decompressor *inflater, const void *data, size_t size,
                       void *room, float *out)
{
    size_t count = (size_t)p->part_width * (size_t)p->samples, row = count * (size_t)p->bits / 8;
    size_t bytes = row * (size_t)p->part_height;
    if (p->compression == DEFLATE || p->compression == OLD_DEFLATE) {
        if (libdeflate_zlib_decompress(inflater, data, size, room, bytes, NULL) != LIBDEFLATE_SUCCESS) return false;
    } else if (p->compression == PLAIN && size >= bytes) {
        memcpy(room, data, bytes);
    } else {
        return false;
    }
    bool predicted = p->predictor == OF_FLOATS || p->predictor == OF_FLOATS_2 || p->predictor == OF_FLOATS_4;
    for (size_t y = 0; y < (size_t)p->part_height; y++) {
        uint8_t *from = (uint8_t *)room + y * row;
        if (predicted)
            undo_predictor(p, from, out + y * count);
        else
            take_row(p, from, out + y * count);
    }
    return true;
}
