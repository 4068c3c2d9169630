/* SPDX-License-Identifier: MIT */
#include "image/metadata/icc.h"

#include <math.h>
#include <string.h>

enum { HEAD = 128, TAG = 12, MOST_TAGS = 100, SPACE_AT = 16 };

/* A range of bytes, read as big-endian numbers; 0 beyond the end. */
typedef struct bytes {
    const unsigned char *at;
    size_t size;
} bytes;

static uint32_t number(bytes b, size_t at, size_t count)
{
    uint32_t sum = 0;
    if (at > b.size || count > b.size - at) return 0;
    for (size_t i = 0; i < count; i++)
        sum = sum << 8 | b.at[at + i];
    return sum;
}

static bool is_word(bytes b, size_t at, const char *word)
{
    return at <= b.size && b.size - at >= 4 && memcmp(b.at + at, word, 4) == 0;
}

/* Reads a signed fixed-point number in units of 1/65536. */
static double fixed(bytes b, size_t at)
{
    return (double)(int32_t)number(b, at, 4) / 65536;
}

static bool find_tag(bytes b, const char *name, bytes *out)
{
    uint32_t count = number(b, HEAD, 4);
    for (size_t i = 0; i < count && i < MOST_TAGS; i++) {
        size_t entry = HEAD + 4 + TAG * i, at = number(b, entry + 4, 4), size = number(b, entry + 8, 4);
        if (!is_word(b, entry, name)) continue;
        if (at > b.size || size > b.size - at) return false;
        *out = (bytes){b.at + at, size};
        return true;
    }
    return false;
}

int icc_channels(const void *profile, size_t size)
{
    bytes b = {profile, size};
    if (!is_word(b, SPACE_AT + 20, "acsp")) return 0;
    if (is_word(b, SPACE_AT, "GRAY")) return 1;
    if (is_word(b, SPACE_AT, "CMYK")) return 4;
    return is_word(b, SPACE_AT, "RGB ") || is_word(b, SPACE_AT, "Lab ") ? 3 : 0;
}

/* ---- curves ---- */

/* A profile's curve as stored: parametric or sampled. */
typedef struct curve {
    int function; /* number of the parametric function; -1: samples */
    double p[7];  /* parameters g a b c d e f */
    bytes samples;
    uint32_t sample_count;
} curve;

static bool read_parameters(bytes tag, curve *out)
{
    static const int counts[5] = {1, 3, 4, 5, 7};
    uint32_t function = number(tag, 8, 2);
    if (function > 4) return false;
    *out = (curve){.function = (int)function, .p = {1, 1}};
    for (int i = 0; i < counts[function]; i++)
        out->p[i] = fixed(tag, 12 + 4 * (size_t)i);
    return true;
}

static bool read_samples(bytes tag, curve *out)
{
    uint32_t count = number(tag, 8, 4);
    *out = (curve){.function = 0, .p = {1, 1}};
    if (count == 0) return true;
    if (count == 1) {
        out->p[0] = number(tag, 12, 2) / 256.0;
        return true;
    }
    if (tag.size < 12 || count > (tag.size - 12) / 2) return false;
    *out = (curve){.function = -1, .samples = {tag.at + 12, tag.size - 12}, .sample_count = count};
    return true;
}

static bool read_curve(bytes profile, const char *name, curve *out)
{
    bytes tag;
    if (!find_tag(profile, name, &tag)) return false;
    if (is_word(tag, 0, "para")) return read_parameters(tag, out);
    return is_word(tag, 0, "curv") && read_samples(tag, out);
}

static double evaluate(const curve *c, double x)
{
    const double *p = c->p, line = c->function == 4 ? p[3] * x + p[6] : p[3] * x;
    if (c->function < 0) {
        double at = x * (c->sample_count - 1);
        uint32_t low = (uint32_t)at, high = low + 1 < c->sample_count ? low + 1 : low;
        double a = number(c->samples, 2 * (size_t)low, 2), b = number(c->samples, 2 * (size_t)high, 2);
        return (a + (b - a) * (at - low)) / 65535;
    }
    if (c->function == 0) return pow(x, p[0]);
    if (c->function >= 3 && x < p[4]) return line;
    double base = p[1] * x + p[2], power = base > 0 ? pow(base, p[0]) : 0;
    if (c->function == 2) return power + p[3];
    return c->function == 4 ? power + p[5] : power;
}

static double decode_srgb(double v)
{
    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

/* Returns how far the curve is from a power, or for exponent 0 from sRGB's. */
static double distance_from(const curve *c, double exponent)
{
    double most = 0;
    for (int i = 0; i <= 32; i++) {
        double x = i / 32.0, other = exponent > 0 ? pow(x, exponent) : decode_srgb(x);
        most = fmax(most, fabs(evaluate(c, x) - other));
    }
    return most;
}

static bool name_curve(const curve *c, picture_light *out)
{
    const double close = 2e-3, half = evaluate(c, 0.5), exponent = half > 0 && half < 1 ? log(half) / log(0.5) : 0;
    out->said = true;
    out->curve = PICTURE_CURVE_SRGB;
    if (distance_from(c, 0) < close) return true;
    out->curve = PICTURE_CURVE_POWER;
    out->exponent = (float)exponent;
    if (fabs(exponent - 1) < 1e-3) out->exponent = 1;
    return exponent > 0.1 && exponent < 10 && distance_from(c, exponent) < close;
}

static bool are_same(const curve *a, const curve *b)
{
    for (int i = 1; i < 16; i++)
        if (!(fabs(evaluate(a, i / 16.0) - evaluate(b, i / 16.0)) < 2e-3)) return false;
    return true;
}

/* ---- primaries ---- */

/* Reads a colour of the profile as a chromaticity, and adds it to sum; returns false for black. */
static bool read_place(bytes profile, const char *name, double sum[3], float xy[2])
{
    bytes tag;
    double all = 0, c[3];
    if (!find_tag(profile, name, &tag) || !is_word(tag, 0, "XYZ ")) return false;
    for (int i = 0; i < 3; i++) {
        c[i] = fixed(tag, 8 + 4 * (size_t)i);
        sum[i] += c[i];
        all += c[i];
    }
    if (!(all > 1e-3)) return false;
    xy[0] = (float)(c[0] / all);
    xy[1] = (float)(c[1] / all);
    return true;
}

/* Reads the primaries. Profiles store colours under D50, also white, which is their sum. */
static bool read_primaries(bytes profile, float xy[8])
{
    static const char *const names[3] = {"rXYZ", "gXYZ", "bXYZ"};
    double sum[3] = {0, 0, 0};
    for (int i = 0; i < 3; i++)
        if (!read_place(profile, names[i], sum, xy + 2 * (size_t)i)) return false;
    double all = sum[0] + sum[1] + sum[2];
    if (!(all > 1e-3)) return false;
    xy[6] = (float)(sum[0] / all);
    xy[7] = (float)(sum[1] / all);
    return true;
}

bool icc_light(const void *profile, size_t size, picture_light *out)
{
    const bytes b = {profile, size};
    curve red, green, blue;
    bytes table;
    *out = (picture_light){.said = false};
    if (!is_word(b, SPACE_AT, "RGB ") || !is_word(b, SPACE_AT + 4, "XYZ ") || find_tag(b, "A2B0", &table)) return false;
    if (!read_curve(b, "rTRC", &red) || !read_curve(b, "gTRC", &green) || !read_curve(b, "bTRC", &blue)) return false;
    if (!are_same(&red, &green) || !are_same(&red, &blue) || !name_curve(&red, out)) return false;
    float xy[8];
    if (!read_primaries(b, xy)) return false;
    out->has_primaries = true; /* sRGB's own under D50, too, have different numbers */
    memcpy(out->xy, xy, sizeof out->xy);
    return true;
}
