/* SPDX-License-Identifier: MIT */
#include "image/color.h"

#include <math.h>
#include <pthread.h>

enum { GUESSES = 4096 };

static pthread_once_t once8 = PTHREAD_ONCE_INIT, once16 = PTHREAD_ONCE_INIT;
static float decode8[256], decode16[65536];
static float threshold[257];             /* threshold: smallest linear value of each code, and infinity for a 256th */
static uint8_t first_guess[GUESSES + 1]; /* first_guess: code at i / GUESSES, rounded down */

/* Encodes by IEC 61966-2-1. */
float srgb_encode(float linear)
{
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * powf(linear, 1 / 2.4f) - 0.055f;
}

float srgb_decode(float encoded)
{
    return encoded <= 0.04045f ? encoded / 12.92f : powf((encoded + 0.055f) / 1.055f, 2.4f);
}

static double decode(double encoded)
{
    return encoded <= 0.04045 ? encoded / 12.92 : pow((encoded + 0.055) / 1.055, 2.4);
}

static void fill8(void)
{
    for (int i = 0; i < 256; i++) {
        decode8[i] = (float)decode(i / 255.0);
        threshold[i] = i ? (float)decode((i - 0.5) / 255.0) : 0;
    }
    threshold[256] = INFINITY;
    int code = 0;
    for (int i = 0; i <= GUESSES; i++) {
        while (code < 255 && threshold[code + 1] <= (float)i / GUESSES)
            code++;
        first_guess[i] = (uint8_t)code;
    }
}

static void fill16(void)
{
    for (int i = 0; i < 65536; i++)
        decode16[i] = (float)decode(i / 65535.0);
}

const float *srgb_decode_table8(void)
{
    pthread_once(&once8, fill8);
    return decode8;
}

const float *srgb_decode_table16(void)
{
    pthread_once(&once16, fill16);
    return decode16;
}

void srgb_codes8(const float *linear, size_t count, uint8_t *codes)
{
    pthread_once(&once8, fill8);
    for (size_t i = 0; i < count; i++) {
        float x = linear[i] > 0 ? linear[i] : 0;
        x = x < 1 ? x : 1;
        /* codes are at least 1/3295 apart, so that at most one begins between the guess and x */
        int code = first_guess[(int)(x * GUESSES)];
        codes[i] = (uint8_t)(code + (x >= threshold[code + 1]));
    }
}

uint8_t srgb_code8(float linear)
{
    uint8_t code;
    srgb_codes8(&linear, 1, &code);
    return code;
}
