#include "image/color.h"

#include <math.h>
#include <pthread.h>

#include "image/write.h"

enum { GUESSES = 4096 };

static pthread_once_t once8 = PTHREAD_ONCE_INIT, once16 = PTHREAD_ONCE_INIT;
static float decode8[256], decode16[65536];
static float threshold[256];             /* the smallest linear value of each code */
static uint8_t first_guess[GUESSES + 1]; /* the code at i / GUESSES, from below */

/* IEC 61966-2-1. */
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

uint8_t srgb_code8(float linear)
{
    pthread_once(&once8, fill8);
    if (!(linear > 0)) return 0;
    if (linear >= 1) return 255;
    int code = first_guess[(int)(linear * GUESSES)];
    while (code < 255 && linear >= threshold[code + 1])
        code++;
    return (uint8_t)code;
}
